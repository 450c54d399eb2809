// Sphinx looks whether there is a "var" of this name. How pages are ranked: what one reads before what one looks at, and titles first.
var Scorer = {
  score: ([page, , , , score]) => {
    if (page.startsWith("gallery/")) return score - 40;
    if (page.startsWith("how-to/")) return score + 10;
    return score;
  },
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
