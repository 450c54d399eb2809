// The gallery's filters: a card stays if it has all that is chosen. The address keeps the choice.
document.querySelectorAll("form.filters").forEach((form) => {
  const cards = [...document.querySelectorAll(".wall > li")];
  const choices = [...form.querySelectorAll("select")];
  const show = () => {
    for (const card of cards) {
      card.hidden = choices.some(({ name, value }) => value && !card.dataset[name].split(" ").includes(value));
    }
    const count = cards.filter((card) => !card.hidden).length;
    form.querySelector("output").value = `${count} of ${cards.length}`;
  };
  const given = new URLSearchParams(location.hash.slice(1));
  for (const choice of choices) {
    const value = given.get(choice.name) ?? "";
    if ([...choice.options].some((option) => option.value === value)) choice.value = value;
  }
  form.addEventListener("change", () => {
    const chosen = choices.filter(({ value }) => value).map(({ name, value }) => [name, value]);
    history.replaceState(null, "", `#${new URLSearchParams(chosen)}`);
    show();
  });
  show();
});
