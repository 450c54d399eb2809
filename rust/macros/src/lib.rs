//! `#[guarded]`, for everything that Python can call: see `rust/py/src/boundary.rs`.

use proc_macro::{Delimiter, Group, TokenStream, TokenTree};

/// Methods whose results Python takes as they are, not as objects.
const SLOTS: [&str; 2] = ["__len__", "__hash__"];

/// Run the body of a function, or of all functions of an `impl`, inside `crate::boundary`, which turns a
/// panic of the body, or of the conversion of its result, into an error. It stands above `#[pyfunction]`
/// and `#[pymethods]`.
#[proc_macro_attribute]
pub fn guarded(_: TokenStream, item: TokenStream) -> TokenStream {
    let tokens: Vec<TokenTree> = item.into_iter().collect();
    if is_function(&tokens) {
        return function(&tokens);
    }
    let block = |token: &TokenTree| match token {
        TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => {
            let mut block = Group::new(Delimiter::Brace, functions(group.stream()));
            block.set_span(group.span());
            block.into()
        }
        other => other.clone(),
    };
    tokens.iter().map(block).collect()
}

/// The items of an `impl`, its functions guarded.
fn functions(items: TokenStream) -> TokenStream {
    let (mut guarded, mut item) = (TokenStream::new(), Vec::new());
    for token in items {
        let is_last = is_block(&token);
        item.push(token);
        if is_last {
            let one = std::mem::take(&mut item);
            guarded.extend(if is_function(&one) {
                function(&one)
            } else {
                one.into_iter().collect()
            });
        }
    }
    guarded.extend(item);
    guarded
}

/// A function: attributes, signature, perhaps a result, and a block.
fn function(tokens: &[TokenTree]) -> TokenStream {
    let start = tokens.iter().position(|token| is_word(token, "fn")).unwrap_or(0);
    let is_arguments = |token: &TokenTree| is_group(token, Delimiter::Parenthesis);
    let arguments = start + tokens[start..].iter().position(is_arguments).unwrap_or(0);
    let (body, before) = (&tokens[tokens.len() - 1], &tokens[..=arguments]);
    // Behind the arrow.
    let result = &tokens[(arguments + 3).min(tokens.len() - 1)..tokens.len() - 1];
    let fallible = result.first().is_some_and(|token| is_word(token, "PyResult"));
    let value = if fallible { &result[2..result.len() - 1] } else { result };
    let text = |tokens: &[TokenTree]| tokens.iter().cloned().collect::<TokenStream>();
    let name = tokens[start + 1].to_string();
    let is_unit = value.is_empty() || (value.len() == 1 && value[0].to_string() == "()");
    let plain = is_unit || is_new(&tokens[..start]) || SLOTS.contains(&&*name);
    let mut guarded = text(before);
    let value = if value.is_empty() { parsed("()") } else { text(value) };
    guarded.extend(parsed(if plain {
        "-> pyo3::PyResult"
    } else {
        "-> crate::boundary::Returned"
    }));
    guarded.extend(parsed("<").into_iter().chain(value.clone()).chain(parsed(">")));
    // The block of a closure of its own, in which `return` and `?` mean what they did.
    let work = parsed("move || -> ").into_iter();
    let work: TokenStream = if fallible {
        work.chain(parsed("pyo3::PyResult<")).chain(value).chain(parsed(">")).collect()
    } else {
        work.chain(value).collect()
    };
    let work = work.into_iter().chain([body.clone()]).collect::<TokenStream>();
    let call = match (plain, fallible) {
        (true, true) => "crate::boundary::caught",
        (true, false) => "crate::boundary::caught_value",
        (false, true) => "crate::boundary::returned",
        (false, false) => "crate::boundary::returned_value",
    };
    let call = parsed(call).into_iter().chain([Group::new(Delimiter::Parenthesis, work).into()]);
    guarded.extend([TokenTree::from(Group::new(Delimiter::Brace, call.collect()))]);
    guarded
}

fn parsed(text: &str) -> TokenStream {
    text.parse().unwrap_or_default()
}

fn is_function(tokens: &[TokenTree]) -> bool {
    tokens.last().is_some_and(is_block) && tokens.iter().any(|token| is_word(token, "fn"))
}

fn is_block(token: &TokenTree) -> bool {
    is_group(token, Delimiter::Brace)
}

fn is_group(token: &TokenTree, delimiter: Delimiter) -> bool {
    matches!(token, TokenTree::Group(group) if group.delimiter() == delimiter)
}

fn is_word(token: &TokenTree, word: &str) -> bool {
    matches!(token, TokenTree::Ident(ident) if ident.to_string() == word)
}

/// Whether the attribute `#[new]` is there.
fn is_new(attributes: &[TokenTree]) -> bool {
    attributes
        .iter()
        .any(|token| is_group(token, Delimiter::Bracket) && token.to_string() == "[new]")
}
