// IPOS sources for tree-sitter: what stands where, as far as colours, folds and text objects need it. A source that is
// being written parses, too: a block holds any items. The words are those of words.json, made by syntax.py.
const words = require("./words.json");

const anyOf = (names) => choice(...names);
const operators = words.punctuator.filter((one) => !"{}()[];,.".includes(one));

module.exports = grammar({
  name: "ipos",

  extras: ($) => [/\s/, $.comment],
  word: ($) => $.identifier,

  rules: {
    source_file: ($) => repeat($._item),

    _item: ($) =>
      choice(
        $.directive,
        $.function,
        $.call,
        $.member,
        $.block,
        $.group,
        $.index,
        $.control,
        $.type,
        $.modifier,
        $.word_operator,
        $.foreign,
        $.raw_variable,
        $.identifier,
        $.number,
        $.string,
        $.operator,
        ";",
        ",",
      ),

    // main() { ... }
    function: ($) => prec(2, seq(field("name", $.identifier), $.group, field("body", $.block))),
    call: ($) => prec(1, seq(field("function", $.identifier), field("arguments", $.group))),
    member: ($) => seq(".", field("name", $.identifier)),

    block: ($) => seq("{", repeat($._item), "}"),
    group: ($) => seq("(", repeat($._item), ")"),
    index: ($) => seq("[", repeat($._item), "]"),

    control: () => anyOf(words.control),
    type: () => anyOf(words.type),
    modifier: () => anyOf(words.modifier),
    word_operator: () => anyOf(words.operator),
    foreign: () => anyOf(words.foreign),
    operator: () => anyOf(operators),

    // One token: '#' is nothing else.
    directive: ($) => seq($.directive_word, optional($.header)),
    directive_word: () => token(seq("#", /[ \t]*/, anyOf(words.directive))),
    header: () => token.immediate(/[ \t]*<[^>\n]*>/),

    raw_variable: () => token(prec(1, /H[0-9]+/)),
    identifier: () => /[A-Za-z_][A-Za-z0-9_]*/,
    number: () => token(choice(/0[xX][0-9A-Fa-f]+/, /0[bB][01]+/, /[0-9]+/)),
    string: () => /"[^"\n]*"/,
    comment: () => token(choice(seq("//", /[^\n]*/), seq("/*", /[^*]*\*+([^/*][^*]*\*+)*/, "/"))),
  },
});
