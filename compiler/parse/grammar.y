// Grammar of the IPOS language (LALR(1) with exact look-ahead for messages). Each action is one call of the Builder.
//
// Recovery: after every `error` only Sync, SyncBlock or SyncBody may follow. No source text holds them; after an
// error the TokenFeed skips to a place where parsing can go on and sends one of them from there. SyncBlock: the block
// of a function follows; SyncBody: its '{' is missing.
%skeleton "lalr1.cc"
%require "3.8"
%define api.namespace {ipos::compiler}
%define api.parser.class {Parser}
%define api.value.type {SemanticValue}
%define api.token.raw
%define api.location.type {Span}
%define parse.lac full
%define parse.error custom
%locations

%code requires {
#include "compiler/parse/builder.hpp"

namespace ipos::compiler {
class TokenFeed;
}
}
%code {
#include "compiler/parse/token_feed.hpp"

namespace {

int yylex(ipos::compiler::SemanticValue* value, ipos::compiler::Span* span, ipos::compiler::TokenFeed& feed) {
  const ipos::compiler::Symbol symbol = feed.next();
  *value = symbol.value;
  *span = symbol.span;
  return symbol.kind;
}

}  // namespace
}
%param { TokenFeed& feed }
%parse-param { Builder& build }

%token
  LeftBrace "{"  RightBrace "}"  LeftParen "("  RightParen ")"  LeftBracket "["  RightBracket "]"
  Semicolon ";"  Comma ","  Colon ":"  Question "?"  Dot "."  Arrow "->"
  Plus "+"  Minus "-"  Star "*"  Slash "/"  Percent "%"  ShiftLeft "<<"  ShiftRight ">>"
  Less "<"  LessEqual "<="  Greater ">"  GreaterEqual ">="  EqualEqual "=="  NotEqual "!="
  And "&"  Xor "^"  Or "|"  AndAnd "&&"  OrOr "||"  Not "!"  BitNot "~"  Increment "++"  Decrement "--"
  Assign "="  PlusAssign "+="  MinusAssign "-="  StarAssign "*="  SlashAssign "/="  PercentAssign "%="
  ShiftLeftAssign "<<="  ShiftRightAssign ">>="  AndAssign "&="  XorAssign "^="  OrAssign "|="
  Long "long"  Initial "initial"  Typedef "typedef"  Struct "struct"  Numof "numof"
  If "if"  Else "else"  For "for"  While "while"  Do "do"  Switch "switch"  Case "case"  Default "default"
  Break "break"  Continue "continue"  Return "return"  Goto "goto"  Sizeof "sizeof"
  Pragma "#pragma"  Declare "#declare"  DirectiveEnd "end of line"
  Sync SyncBlock SyncBody
%token <number> Number "number"
%token <ident> Identifier "name"  TypeName "structure type"
%token <ident> ForeignType "foreign type"  ForeignQualifier "foreign qualifier"

%nterm <ident> name new_type
%nterm <type> type basic_type
%nterm <declarator> declarator init_declarator
%nterm <declarators> declarators
%nterm <variables> variables member
%nterm <members> members
%nterm <stmt> statement item block
%nterm <stmts> items
%nterm <for_head> for_head
%nterm <expr> expression expr condition optional bound
%nterm <exprs> arguments

%precedence Then
%precedence "else"
%right "=" "+=" "-=" "*=" "/=" "%=" "<<=" ">>=" "&=" "^=" "|="
%right "?" ":"
%left "||"
%left "&&"
%left "|"
%left "^"
%left "&"
%left "==" "!="
%left "<" "<=" ">" ">="
%left "<<" ">>"
%left "+" "-"
%left "*" "/" "%"
%precedence Prefix
%precedence "++" "--" "[" "." "->"

%%

program: declarations;

declarations: %empty | declarations declaration;

declaration:
    variables                                  { build.global($1); }
  | "typedef" "struct" tag "{" members "}" new_type ";"  { build.structure(@$, $7, $5); }
  | "typedef" "struct" tag "{" members "}" error Sync    { yyerrok; }
  | Identifier "(" ")" block                   { build.function(@$, $1, $4); }
  | type Identifier "(" ")" block              { build.function_with_result(@$, @1, $2, $5); }
  | Identifier "(" ")" ";"                     { build.problem(Diag::Prototype, @$, $1.text); }
  | type Identifier "(" ")" ";"                { build.problem(Diag::Prototype, @$, $2.text); }
  | directive
  | ";"
  | error Sync                                 { yyerrok; }
  | error SyncBlock block                      { yyerrok; }
  | error SyncBody items "}"                   { yyerrok; }
  ;

tag: %empty | Identifier | TypeName;

new_type: name                                 { $$ = build.new_type($1); };

name: Identifier | TypeName;

members:
    %empty                                     { $$ = build.list<ParsedVariables>(); }
  | members member                             { $$ = build.append($1, $2); }
  ;

member:
    type declarators ";"                       { $$ = build.variables(@$, false, $1, $2); }
  | error Sync                                 { yyerrok; $$ = build.keep(ParsedVariables{}); }
  ;

variables:
    type declarators ";"                       { $$ = build.variables(@$, false, $1, $2); }
  | "initial" type declarators ";"             { $$ = build.variables(@$, true, $2, $3); }
  ;

type:
    basic_type
  | TypeName                                   { $$ = build.type($1); }
  | ForeignQualifier type                      { $$ = build.qualified($1, $2); }
  | "struct" name                              { $$ = build.struct_type(@$, $2); }
  ;

basic_type:
    "long"                                     { $$ = build.type({"long", @1}); }
  | ForeignType                                { $$ = build.foreign_type(@$, $1); }
  | basic_type "long"                          { $$ = build.two_types($1, {"long", @2}); }
  | basic_type ForeignType                     { $$ = build.two_types($1, $2); }
  ;

declarators:
    init_declarator                            { $$ = build.append(build.list<ParsedDeclarator>(), $1); }
  | declarators "," init_declarator            { $$ = build.append($1, $3); }
  ;

init_declarator:
    declarator
  | declarator "=" expr                        { $$ = build.initialized($1, @2); }
  | declarator "=" "{" arguments "}"           { $$ = build.initialized($1, @2); }
  ;

declarator:
    Identifier                                 { $$ = build.declarator($1); }
  | TypeName                                   { $$ = build.declared_type($1); }
  | declarator "[" expression "]"              { $$ = build.array($1, @2, $3); }
  | "*" declarator                             { $$ = build.pointer(@1, $2); }
  ;

directive:
    "#pragma" Identifier "end of line"         { build.pragma(@$, $2); }
  | "#pragma" Identifier bound bound "end of line"  { build.pragma_range(@$, $2, $3, $4); }
  | "#declare" name Identifier "end of line"   { build.alias(@$, $2, $3); }
  | "#declare" name Identifier "+" expr "end of line"  { build.alias_behind(@$, $2, $3, @4, $5); }
  | "#pragma" error Sync                       { yyerrok; }
  | "#declare" error Sync                      { yyerrok; }
  ;

bound:
    Number                                     { $$ = build.number(@$, $1); }
  | Identifier                                 { $$ = build.name($1); }
  | "(" expression ")"                         { $$ = build.parenthesized(@$, $2); }
  ;

block: "{" items "}"                           { $$ = build.block(@$, $2); };

items:
    %empty                                     { $$ = build.list<ast::StmtPtr>(); }
  | items item                                 { $$ = build.append($1, $2); }
  ;

item:
    statement
  | "case" expr ":"                            { $$ = build.case_label(@$, $2); }
  | "default" ":"                              { $$ = build.simple<ast::Default>(@$); }
  | variables                                  { build.local($1); $$ = nullptr; }
  | directive                                  { $$ = nullptr; }
  | Identifier ":"                             { build.problem(Diag::Label, @$, $1.text); $$ = nullptr; }
  ;

statement:
    block
  | ";"                                        { $$ = build.simple<ast::Empty>(@$); }
  | expression ";"                             { $$ = build.expression_statement(@$, $1); }
  | "if" condition statement %prec Then        { $$ = build.if_statement(@$, $2, $3, nullptr); }
  | "if" condition statement "else" statement  { $$ = build.if_statement(@$, $2, $3, $5); }
  | "while" condition statement                { $$ = build.while_statement(@$, $2, $3); }
  | "do" statement "while" condition ";"       { $$ = build.do_while(@$, $2, $4); }
  | "do" statement error Sync                  { yyerrok; $$ = nullptr; }
  | "do" statement "while" condition error Sync  { yyerrok; $$ = nullptr; }
  | "for" for_head statement                   { $$ = build.for_statement(@$, $2, $3); }
  | "switch" condition statement               { $$ = build.switch_statement(@$, $2, $3); }
  | "break" ";"                                { $$ = build.simple<ast::Break>(@$); }
  | "continue" ";"                             { $$ = build.simple<ast::Continue>(@$); }
  | "return" ";"                               { $$ = build.simple<ast::Return>(@$); }
  | "return" expression ";"                    { build.problem(Diag::ReturnValue, @2); $$ = nullptr; }
  | "goto" Identifier ";"                      { build.problem(Diag::Goto, @$); $$ = nullptr; }
  | error Sync                                 { yyerrok; $$ = nullptr; }
  ;

condition:
    "(" expression ")"                         { $$ = $2; }
  | error Sync                                 { yyerrok; $$ = nullptr; }
  ;

for_head:
    "(" optional ";" optional ";" optional ")" { $$ = build.for_head($2, $4, $6); }
  | "(" variables optional ";" optional ")"    { build.local($2); $$ = {}; }
  | error Sync                                 { yyerrok; $$ = {}; }
  ;

optional:
    %empty                                     { $$ = nullptr; }
  | expression
  ;

arguments:
    expr                                       { $$ = build.append(build.list<ast::ExprPtr>(), $1); }
  | arguments "," expr                         { $$ = build.append($1, $3); }
  ;

expression:
    expr
  | expression "," expr                        { $$ = build.comma(@$, $1, $3); }
  ;

expr:
    Number                                     { $$ = build.number(@$, $1); }
  | Identifier                                 { $$ = build.name($1); }
  | Identifier "(" ")"                         { $$ = build.call(@$, $1, nullptr); }
  | Identifier "(" arguments ")"               { $$ = build.call(@$, $1, $3); }
  | "(" expression ")"                         { $$ = build.parenthesized(@$, $2); }
  | "(" type ")" expr %prec Prefix             { $$ = build.replaced(Diag::Cast, @1, @3, $4); }
  | "numof" "(" expression ")"                 { $$ = build.numof(@$, $3); }
  | "sizeof" "(" expression ")"                { $$ = build.replaced(Diag::SizeOf, @1, @1, $3); }
  | "sizeof" "(" type ")"                      { $$ = build.missing(Diag::SizeOf, @1); }
  | expr "[" expression "]"                    { $$ = build.index(@$, $1, $3); }
  | expr "." Identifier                        { $$ = build.member(@$, $1, $3); }
  | expr "->" Identifier                       { $$ = build.arrow(@$, $1, @2, $3); }
  | expr "++"                                  { $$ = build.step(@$, ast::StepOp::PostIncrement, $1); }
  | expr "--"                                  { $$ = build.step(@$, ast::StepOp::PostDecrement, $1); }
  | "++" expr %prec Prefix                     { $$ = build.step(@$, ast::StepOp::PreIncrement, $2); }
  | "--" expr %prec Prefix                     { $$ = build.step(@$, ast::StepOp::PreDecrement, $2); }
  | "+" expr %prec Prefix                      { $$ = build.unary(@$, ast::UnaryOp::Plus, $2); }
  | "-" expr %prec Prefix                      { $$ = build.unary(@$, ast::UnaryOp::Minus, $2); }
  | "!" expr %prec Prefix                      { $$ = build.unary(@$, ast::UnaryOp::Not, $2); }
  | "~" expr %prec Prefix                      { $$ = build.unary(@$, ast::UnaryOp::BitNot, $2); }
  | "*" expr %prec Prefix                      { $$ = build.deref(@$, $2); }
  | "&" expr %prec Prefix                      { $$ = build.replaced(Diag::AddressOf, @1, @1, $2); }
  | expr "*" expr                              { $$ = build.binary(@$, ast::BinaryOp::Mul, $1, @2, $3); }
  | expr "/" expr                              { $$ = build.binary(@$, ast::BinaryOp::Div, $1, @2, $3); }
  | expr "%" expr                              { $$ = build.binary(@$, ast::BinaryOp::Mod, $1, @2, $3); }
  | expr "+" expr                              { $$ = build.binary(@$, ast::BinaryOp::Add, $1, @2, $3); }
  | expr "-" expr                              { $$ = build.binary(@$, ast::BinaryOp::Sub, $1, @2, $3); }
  | expr "<<" expr                             { $$ = build.binary(@$, ast::BinaryOp::Shl, $1, @2, $3); }
  | expr ">>" expr                             { $$ = build.binary(@$, ast::BinaryOp::Shr, $1, @2, $3); }
  | expr "<" expr                              { $$ = build.binary(@$, ast::BinaryOp::Lt, $1, @2, $3); }
  | expr "<=" expr                             { $$ = build.binary(@$, ast::BinaryOp::Le, $1, @2, $3); }
  | expr ">" expr                              { $$ = build.binary(@$, ast::BinaryOp::Gt, $1, @2, $3); }
  | expr ">=" expr                             { $$ = build.binary(@$, ast::BinaryOp::Ge, $1, @2, $3); }
  | expr "==" expr                             { $$ = build.binary(@$, ast::BinaryOp::Eq, $1, @2, $3); }
  | expr "!=" expr                             { $$ = build.binary(@$, ast::BinaryOp::Ne, $1, @2, $3); }
  | expr "&" expr                              { $$ = build.binary(@$, ast::BinaryOp::And, $1, @2, $3); }
  | expr "^" expr                              { $$ = build.binary(@$, ast::BinaryOp::Xor, $1, @2, $3); }
  | expr "|" expr                              { $$ = build.binary(@$, ast::BinaryOp::Or, $1, @2, $3); }
  | expr "&&" expr                             { $$ = build.binary(@$, ast::BinaryOp::LogicalAnd, $1, @2, $3); }
  | expr "||" expr                             { $$ = build.binary(@$, ast::BinaryOp::LogicalOr, $1, @2, $3); }
  | expr "?" expression ":" expr               { $$ = build.conditional(@$, $1, $3, $5); }
  | expr "=" expr                              { $$ = build.assign(@$, {}, $1, @2, $3); }
  | expr "*=" expr                             { $$ = build.assign(@$, ast::BinaryOp::Mul, $1, @2, $3); }
  | expr "/=" expr                             { $$ = build.assign(@$, ast::BinaryOp::Div, $1, @2, $3); }
  | expr "%=" expr                             { $$ = build.assign(@$, ast::BinaryOp::Mod, $1, @2, $3); }
  | expr "+=" expr                             { $$ = build.assign(@$, ast::BinaryOp::Add, $1, @2, $3); }
  | expr "-=" expr                             { $$ = build.assign(@$, ast::BinaryOp::Sub, $1, @2, $3); }
  | expr "<<=" expr                            { $$ = build.assign(@$, ast::BinaryOp::Shl, $1, @2, $3); }
  | expr ">>=" expr                            { $$ = build.assign(@$, ast::BinaryOp::Shr, $1, @2, $3); }
  | expr "&=" expr                             { $$ = build.assign(@$, ast::BinaryOp::And, $1, @2, $3); }
  | expr "^=" expr                             { $$ = build.assign(@$, ast::BinaryOp::Xor, $1, @2, $3); }
  | expr "|=" expr                             { $$ = build.assign(@$, ast::BinaryOp::Or, $1, @2, $3); }
  ;

%%
