// Declarations and directives of the tree.
#include "compiler/parse/builder.hpp"

namespace ipos::compiler {
namespace {

void add_problems(Problems& all, Problems more) {
  for (Problem& problem : more) all.push_back(std::move(problem));
}

}  // namespace

void Builder::report(const Problems& problems) {
  for (const Problem& problem : problems) diagnostics_.report(problem.diag, problem.span, problem.args);
}

void Builder::problem(Diag diag, Span span, std::string_view name) {
  diagnostics_.report(diag, span, {std::string(name)});
}

void Builder::global(ParsedVariables* variables) {
  report(variables->problems);
  program_.declarations.emplace_back(std::move(variables->decl));
}

// The tree takes it as what it should have been, a global.
void Builder::local(ParsedVariables* variables) {
  // Where a '}' is missing before it the declaration is innocent; the missing brace is reported elsewhere.
  const ast::Ident& first = variables->decl.declarators[0].name;
  if (!(open_brace_ && is_line_head(variables->decl.span)))
    diagnostics_.report(Diag::LocalDeclaration, variables->decl.span, {std::string(first.text)});
  program_.declarations.emplace_back(std::move(variables->decl));
}

bool Builder::is_line_head(Span span) const { return map_.position(span.begin).column == 1; }

void Builder::structure(Span span, ast::Ident name, std::vector<ParsedVariables>* members) {
  ast::StructDecl decl{span, name, {}};
  for (ParsedVariables& member : *members) {
    report(member.problems);
    if (!member.decl.declarators.empty()) decl.members.push_back(std::move(member.decl));
  }
  program_.declarations.emplace_back(std::move(decl));
}

void Builder::function(Span span, ast::Ident name, ast::StmtPtr body) {
  program_.declarations.emplace_back(ast::FunctionDecl{span, name, body});
}

void Builder::function_with_result(Span span, Span type, ast::Ident name, ast::StmtPtr body) {
  diagnostics_.report(Diag::FunctionResult, type, {std::string(name.text)});
  function(span, name, body);
}

ast::Ident Builder::new_type(ast::Ident name) {
  types_.insert(name.text);
  return name;
}

ParsedVariables* Builder::variables(Span span, bool initial, ParsedType* type,
                                    std::vector<ParsedDeclarator>* declarators) {
  ParsedVariables all{{span, initial, type->name, {}}, std::move(type->problems)};
  for (ParsedDeclarator& one : *declarators) {
    all.decl.declarators.push_back(std::move(one.declarator));
    add_problems(all.problems, std::move(one.problems));
  }
  return keep(std::move(all));
}

ParsedType* Builder::type(ast::Ident word) { return keep(ParsedType{word, {}}); }

ParsedType* Builder::qualified(ast::Ident qualifier, ParsedType* type) {
  type->problems.push_back({Diag::ForeignQualifier, qualifier.span, {std::string(qualifier.text)}});
  return type;
}

ParsedType* Builder::struct_type(Span span, ast::Ident name) {
  Problem problem{Diag::StructWithoutTypedef, span, {std::string(name.text), std::string(name.text)}};
  return keep(ParsedType{name, {std::move(problem)}});
}

ParsedType* Builder::foreign_type(Span span, ast::Ident word) {
  return keep(ParsedType{{"long", span}, {{Diag::ForeignType, span, {std::string(word.text)}}}});
}

// `unsigned long`, `long int`, `long long`: one message for all the words.
ParsedType* Builder::two_types(ParsedType* first, ast::Ident second) {
  const std::string words =
      (first->problems.empty() ? std::string(first->name.text) : first->problems[0].args[0]) + ' ' +
      std::string(second.text);
  const Span span{first->name.span.begin, second.span.end};
  return keep(ParsedType{{"long", span}, {{Diag::ForeignType, span, {words}}}});
}

ParsedDeclarator* Builder::declarator(ast::Ident name) { return keep(ParsedDeclarator{{name, nullptr}, {}}); }

ParsedDeclarator* Builder::declared_type(ast::Ident name) {
  Problem problem{Diag::NameIsType, name.span, {std::string(name.text)}};
  return keep(ParsedDeclarator{{name, nullptr}, {std::move(problem)}});
}

ParsedDeclarator* Builder::initialized(ParsedDeclarator* declarator, Span assign) {
  declarator->problems.push_back(
      {Diag::Initializer, assign, {std::string(declarator->declarator.name.text)}});
  return declarator;
}

ParsedDeclarator* Builder::array(ParsedDeclarator* declarator, Span bracket, ast::ExprPtr count) {
  if (declarator->declarator.count != nullptr)
    declarator->problems.push_back(
        {Diag::ArrayOfArrays, bracket, {std::string(declarator->declarator.name.text)}});
  else
    declarator->declarator.count = count;
  return declarator;
}

ParsedDeclarator* Builder::pointer(Span star, ParsedDeclarator* declarator) {
  declarator->problems.push_back(
      {Diag::PointerDeclaration, star, {std::string(declarator->declarator.name.text)}});
  return declarator;
}

void Builder::pragma(Span span, ast::Ident kind) {
  if (kind.text != "list") {
    diagnostics_.report(Diag::BadPragma, span, {std::string(kind.text) + " LOW HIGH"});
    return;
  }
  program_.declarations.emplace_back(ast::PragmaDecl{span, kind, std::nullopt});
}

void Builder::pragma_range(Span span, ast::Ident kind, ast::ExprPtr low, ast::ExprPtr high) {
  if (kind.text == "list") {
    diagnostics_.report(Diag::BadPragma, span, {std::string(kind.text)});
    return;
  }
  program_.declarations.emplace_back(ast::PragmaDecl{span, kind, std::pair(low, high)});
}

void Builder::alias(Span span, ast::Ident name, ast::Ident base) {
  program_.declarations.emplace_back(ast::AliasDecl{span, name, this->name(base)});
}

void Builder::alias_behind(Span span, ast::Ident name, ast::Ident base, Span plus, ast::ExprPtr offset) {
  const Span sum{base.span.begin, offset->span.end};
  program_.declarations.emplace_back(
      ast::AliasDecl{span, name, binary(sum, ast::BinaryOp::Add, this->name(base), plus, offset)});
}

}  // namespace ipos::compiler
