// One walk over the syntax tree collects what is stored where, whose number is taken and what is given to
// system functions; the record of accesses says who reads and writes.
#include "compiler/sema/variable_use.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "compiler/ast/walk.hpp"
#include "compiler/sema/call_graph.hpp"
#include "compiler/sema/fold.hpp"
#include "compiler/sema/written.hpp"
#include "stdlib/header_names.hpp"
#include "stdlib/language_tables.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::compiler {
namespace {

// A declared variable or a part of it, as far as the text alone says.
struct Part {
  const Variable* variable = nullptr;
  Type type;
  std::string_view structure;  // the member belongs to it
  std::string_view member;     // in its first spelling
};

// Arguments of system functions that are only read. Others may write theirs.
struct ReadArgument {
  std::string_view mnemonic;
  size_t argument;
};
constexpr ReadArgument kReadArguments[] = {{"SETSYS", 1}, {"SCOM", 1},  {"MOVLNK", 0}, {"VARINT", 0},
                                           {"BMOV", 2},   {"BMOVN", 2}, {"COPY", 1}};

constexpr std::string_view kPairs[] = {"SSPOSSPEED", "SSPOSRAMP"};

// Bits that have a meaning, of system variables in which a program looks for them (system_variables.def).
struct NamedBits {
  uint32_t number;
  std::array<int32_t, 2> bits;
};
constexpr NamedBits kNamedBits[] = {{stdlib::system_variable("StatusWord"), {19, 20}},
                                    {stdlib::system_variable("ControlWord"), {11, 30}}};

class VariableUse {
 public:
  explicit VariableUse(Context& context) : context_(context) {}

  void run(const ast::Program& program) {
    for (const ast::Decl& decl : program.declarations)
      if (const auto* function = std::get_if<ast::FunctionDecl>(&decl)) ast::walk(function->body, *this);
    for (const Store& store : plain_stores_) check_forgotten(store);
    for (const Variable& variable : context_.scope.variables()) check_written(variable);
  }

  void operator()(const ast::Stmt&) {}
  void operator()(const ast::Expr& expr) {
    if (const auto* node = std::get_if<ast::Numof>(&expr.node)) taken(*node->object);
    if (const auto* node = std::get_if<ast::Deref>(&expr.node)) is_pointer(*node->number);
    if (const auto* node = std::get_if<ast::Assign>(&expr.node)) store(*node);
    if (const auto* node = std::get_if<ast::Call>(&expr.node)) call(*node);
    if (const auto* node = std::get_if<ast::Binary>(&expr.node); node != nullptr && node->op == ast::BinaryOp::And) {
      check_mask(*node->left, *node->right);
      check_mask(*node->right, *node->left);
    }
    if (const auto* node = std::get_if<ast::Assign>(&expr.node);
        node != nullptr && (node->op == ast::BinaryOp::And || node->op == ast::BinaryOp::Or))
      check_mask(*node->target, *node->value);
  }

 private:
  // Of a plain variable into a member that holds a number.
  struct Store {
    Span span;
    std::string member;
    const Variable* value;
  };

  std::optional<Part> part(const ast::Expr& expr) const {
    if (const auto* name = std::get_if<ast::Name>(&expr.node)) {
      const Entity* entity = context_.scope.find(name->text);
      const auto* variable = std::get_if<const Variable*>(entity);
      if (variable == nullptr) return std::nullopt;
      return Part{*variable, (*variable)->type, {}, {}};
    }
    if (const auto* index = std::get_if<ast::Index>(&expr.node)) {
      auto base = part(*index->base);
      if (base) base->type = base->type.element();
      return base;
    }
    const auto* node = std::get_if<ast::Member>(&expr.node);
    auto base = node != nullptr ? part(*node->base) : std::nullopt;
    if (!base || base->type.structure == nullptr) return std::nullopt;
    const StructMember* member = base->type.structure->find(node->member.text);
    if (member == nullptr) return std::nullopt;
    return Part{base->variable, member->type, base->type.structure->name, member->names.front()};
  }

  void mark(const Variable& variable, uint32_t reach, Numbers& numbers) {
    const uint32_t size = std::max(variable.type.size(), reach);
    for (uint32_t n = variable.number; n < variable.number + size && n < kMaxNumbers; ++n) numbers.set(n);
  }

  void taken(const ast::Expr& object) {
    if (const auto of = part(object)) mark(*of->variable, kReachOfNumber, reached_);
    uint32_t number = 0;
    const auto* name = std::get_if<ast::Name>(&object.node);
    if (name == nullptr || !raw_number(name->text, number)) return;
    for (uint32_t n = number; n < number + kReachOfNumber && n < kMaxNumbers; ++n) reached_.set(n);
  }

  // StatusWord & 19
  void check_mask(const ast::Expr& word, const ast::Expr& mask) {
    const auto* name = std::get_if<ast::Name>(&word.node);
    const auto* number = std::get_if<ast::Number>(&mask.node);
    uint32_t which = 0;
    if (name != nullptr && number != nullptr && raw_number(name->text, which) && which >= stdlib::kFirstSystemVariable) check_bit_name(which, *number, mask.span);
    if (name == nullptr || number == nullptr || number->hex || !raw_number(name->text, which)) return;
    for (const NamedBits& row : kNamedBits) {
      if (row.number != which || std::find(row.bits.begin(), row.bits.end(), number->value) == row.bits.end()) continue;
      const std::string text(stdlib::find_system_variable(static_cast<uint16_t>(which))->compiler_name);
      const std::string bit = fmt::format("{}", number->value);
      context_.diagnostics.report(Diag::BitNumber, mask.span, {bit, text, bit});
    }
  }

  // H483 & BIT_DI03: the names of the standard headers are numbers of bits.
  void check_bit_name(uint32_t which, const ast::Number& number, Span span) {
    if (!span.begin.in_macro()) return;
    const std::string_view macro = context_.sources.expansion(span.begin).macro;
    for (const stdlib::HeaderName& row : stdlib::header_names()) {
      if (row.name != macro || !macro.starts_with("BIT_") || row.text != fmt::format("{}", number.value)) continue;
      const auto* variable = stdlib::find_system_variable(static_cast<uint16_t>(which));
      if (variable != nullptr)
        context_.diagnostics.report(Diag::BitNumber, span, {std::string(macro), std::string(variable->compiler_name), std::string(macro)});
      return;
    }
  }

  // Variables in the number after a '*' hold numbers themselves.
  void is_pointer(const ast::Expr& number) {
    const auto visit = [this](const ast::Expr& inner) {
      if (const auto of = part(inner)) mark(*of->variable, 0, pointers_);
    };
    ast::walk(&number, visit);
  }

  void store(const ast::Assign& node) {
    const auto target = part(*node.target);
    if (!target) return;
    bool number = false;
    const auto visit = [&number](const ast::Expr& inner) {
      number = number || std::holds_alternative<ast::Numof>(inner.node);
    };
    ast::walk(node.value, visit);
    if (number) mark(*target->variable, 0, pointers_);
    const auto* use = stdlib::find_member_use(target->structure, target->member);
    if (use == nullptr || node.op) return;
    const auto value = part(*node.value);
    const auto* constant = std::get_if<ast::Number>(&node.value->node);
    if (!use->holds_number() && constant != nullptr)
      check_family(context_, node.value->span, use->constants(), constant->value,
                   fmt::format("'{}'", target->member), name_of(*use, constant->value));
    if (use->holds_number() && constant != nullptr) check_number(*constant, node.value->span);
    if (use->holds_number() && value && value->type.scalar())
      plain_stores_.push_back({node.value->span, std::string(target->member), value->variable});
  }

  std::string name_of(const stdlib::MemberUse& use, int32_t value) const {
    for (const std::string_view beginning : use.constants())
      for (const stdlib::HeaderName& row : stdlib::header_names())
        if (row.name.starts_with(beginning) && row.text == fmt::format("{}", value))
          return std::string(row.name);
    return "nothing";
  }

  // A constant that is the number of a declared variable.
  void check_number(const ast::Number& number, Span span) {
    for (const Variable& variable : context_.scope.variables()) {
      const auto at = static_cast<int64_t>(variable.number);
      if (number.value < at || number.value >= at + variable.type.size()) continue;
      context_.diagnostics
          .report(Diag::NumberOfOther, span, {fmt::format("{}", number.value), variable.name, variable.name})
          .notes.push_back({variable.span, "declared here"});
      return;
    }
  }

  void check_forgotten(const Store& store) {
    const Variable& value = *store.value;
    if (pointers_.test(std::min(value.number, kMaxNumbers - 1))) return;
    context_.diagnostics.report(Diag::NumberForgotten, store.span, {store.member, value.name, value.name});
  }

  void call(const ast::Call& node) {
    const stdlib::SystemFunction* function = stdlib::find_system_function(node.function.text);
    if (function == nullptr) return;
    for (size_t n = 0; n < node.arguments.size(); ++n) {
      const auto given = part(*node.arguments[n]);
      if (!given) continue;
      const bool reads = std::any_of(
          std::begin(kReadArguments), std::end(kReadArguments),
          [&](const auto& row) { return row.mnemonic == function->mnemonic && row.argument == n; });
      if (reads)
        given_.emplace(given->variable, function->name);
      else
        mark(*given->variable, kReachOfNumber, reached_);
    }
  }

  // Initials may be set once and for all by an operator panel, aliases and raw names are numbers others know.
  void check_written(const Variable& variable) {
    if (variable.storage != Storage::Global) return;
    bool read = false, written = false;
    for (uint32_t n = variable.number; n < variable.number + variable.type.size() && n < kMaxNumbers; ++n) {
      if (reached_.test(n)) return;
      const auto found = context_.accesses.find(n);
      if (found == context_.accesses.end()) continue;
      written = written || !found->second.writers.empty();
      read = read || !found->second.readers.empty();
    }
    const auto given = given_.find(&variable);
    if (written) {
      if (given != given_.end()) check_half(variable, given->second);
      return;
    }
    if (!read && given == given_.end()) return;
    context_.diagnostics.report(
        Diag::NeverWritten, variable.span,
        {variable.name, given == given_.end() ? "read" : fmt::format("given to '{}'", given->second)});
  }

  // Of a pair of values for the two directions.
  void check_half(const Variable& variable, std::string_view function) {
    const StructType* type = variable.type.structure;
    if (type == nullptr || variable.type.count != 0 ||
        std::find(std::begin(kPairs), std::end(kPairs), type->name) == std::end(kPairs))
      return;
    for (const StructMember& member : type->members) {
      const auto found = context_.accesses.find(variable.number + member.offset);
      if (found == context_.accesses.end() || found->second.writers.empty())
        context_.diagnostics.report(Diag::HalfWritten, variable.span,
                                    {variable.name, std::string(function), member.names.front()});
    }
  }

  Context& context_;
  Numbers reached_;   // may be written by their number
  Numbers pointers_;  // hold numbers of variables
  std::vector<Store> plain_stores_;
  std::map<const Variable*, std::string_view> given_;  // to system functions that only read
};

}  // namespace

void check_variable_use(const ast::Program& program, Context& context) { VariableUse(context).run(program); }

}  // namespace ipos::compiler
