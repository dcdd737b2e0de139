// Declarations: pragmas hold for the whole program, wherever they stand; everything else is known from its
// place on.
#include "compiler/sema/declarations.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/sema/expressions.hpp"

namespace ipos::compiler {
namespace {

class Declarations {
 public:
  explicit Declarations(Context& context) : context_(context), expressions_(context) {}

  void run(const ast::Program& program) {
    for (const ast::Decl& decl : program.declarations)
      if (const auto* pragma = std::get_if<ast::PragmaDecl>(&decl)) add(*pragma);
    check_ranges();
    for (const ast::Decl& decl : program.declarations) {
      std::visit([&](const auto& row) { declare_one(row); }, decl);
      ++context_.order;
    }
    for (const RangeKind kind : {RangeKind::Globals, RangeKind::Initials}) check_overflow(kind);
  }

 private:
  // How far a range is filled, and the first variable beyond its end.
  struct Fill {
    uint32_t count = 0;
    Span overflow;
  };

  void declare_one(const ast::PragmaDecl&) {}

  void declare_one(const ast::FunctionDecl& decl) {
    if (context_.scope.add(FunctionName{std::string(decl.name.text), functions_, decl.name.span},
                           context_.diagnostics))
      ++functions_;
  }

  void declare_one(const ast::StructDecl& decl) {
    StructType type;
    type.name = decl.name.text;
    type.span = decl.name.span;
    for (const ast::VariableDecl& line : decl.members) {
      for (const ast::Declarator& declarator : line.declarators) {
        const auto member_type = type_of(line.type, declarator);
        if (!member_type) continue;
        if (type.find(declarator.name.text) != nullptr) {
          context_.diagnostics.report(Diag::Redefined, declarator.name.span,
                                      {std::string(declarator.name.text)});
          continue;
        }
        type.members.push_back(
            {{std::string(declarator.name.text)}, *member_type, type.size, declarator.name.span});
        type.size = std::min(type.size + member_type->size(), kHugeSize);
      }
    }
    if (type.members.empty())
      context_.diagnostics.report(Diag::EmptyStructure, decl.name.span, {std::string(decl.name.text)});
    context_.scope.add(std::move(type), context_.diagnostics);
  }

  void declare_one(const ast::VariableDecl& decl) {
    for (const ast::Declarator& declarator : decl.declarators) {
      const auto type = type_of(decl.type, declarator);
      if (!type) {
        context_.reported_names.emplace(declarator.name.text);  // no second message where it is used
        continue;
      }
      const RangeKind kind = decl.initial ? RangeKind::Initials : RangeKind::Globals;
      Fill& fill = fills_[kind == RangeKind::Initials];
      const uint32_t number = context_.program.ranges.of(kind).low + fill.count;
      fill.count = std::min(fill.count + type->size(), kHugeSize);
      if (fill.count > context_.program.ranges.of(kind).size() && !fill.overflow.begin.valid())
        fill.overflow = declarator.name.span;
      context_.scope.add(
          Variable{std::string(declarator.name.text), *type, std::min(number, kHugeSize),
                   decl.initial ? Storage::Initial : Storage::Global, declarator.name.span, context_.order},
          context_.diagnostics);
    }
  }

  void declare_one(const ast::AliasDecl& decl) {
    // BASE is a name, so its place is fixed; BASE + K is the long K variables after its first one.
    const ast::Expr* base = decl.base;
    const auto* sum = std::get_if<ast::Binary>(&base->node);
    std::optional<int32_t> offset = 0;
    if (sum != nullptr && sum->op == ast::BinaryOp::Add) {
      base = sum->left;
      offset = expressions_.constant(*sum->right, "the offset of an alias");
    }
    auto object = expressions_.object(*base);
    if (!object || !offset) {
      context_.reported_names.emplace(decl.name.text);
      return;
    }
    const int64_t number = int64_t{object->place.number} + *offset;
    if (number < 0 || number >= context_.unit.variables) {
      context_.diagnostics.report(Diag::InvalidVariable, decl.base->span,
                                  {fmt::format("{}", number), std::string(context_.unit.name),
                                   fmt::format("{}", context_.unit.variables - 1)});
      return;
    }
    const Type type = *offset == 0 ? object->type : Type{};
    context_.scope.add(Variable{std::string(decl.name.text), type, static_cast<uint32_t>(number),
                                Storage::Alias, decl.name.span, context_.order},
                       context_.diagnostics);
  }

  std::optional<Type> type_of(const ast::Ident& name, const ast::Declarator& declarator) {
    Type type;
    if (name.text != "long") {
      type.structure = context_.scope.find_type(name.text);
      if (type.structure == nullptr) {
        context_.diagnostics.report(Diag::UnknownType, name.span, {std::string(name.text)});
        return std::nullopt;
      }
    }
    if (declarator.count != nullptr) {
      const auto count = expressions_.constant(*declarator.count, "the number of elements");
      if (!count) return std::nullopt;
      if (*count < 1 || *count > context_.unit.variables) {
        context_.diagnostics.report(Diag::ArraySize, declarator.count->span,
                                    {fmt::format("{}", context_.unit.variables), fmt::format("{}", *count)});
        return std::nullopt;
      }
      type.count = static_cast<uint32_t>(*count);
    }
    return type;
  }

  void add(const ast::PragmaDecl& decl) {
    if (!decl.range) return;  // #pragma list
    for (const RangeKind kind : {RangeKind::Globals, RangeKind::Initials, RangeKind::Temporaries}) {
      if (decl.kind.text != pragma_name(kind)) continue;
      const auto low = bound(*decl.range->first);
      const auto high = bound(*decl.range->second);
      if (!low || !high || !possible(*low, *high, decl.span)) return;
      Span& set = pragmas_[static_cast<size_t>(kind)];
      if (set.begin.valid())
        context_.diagnostics.report(Diag::PragmaRepeated, decl.span, {std::string(decl.kind.text)})
            .notes.push_back({set, "the earlier one"});
      set = decl.span;
      context_.program.ranges.of(kind) = {static_cast<uint32_t>(*low), static_cast<uint32_t>(*high)};
      if (kind == RangeKind::Initials && *high > static_cast<int32_t>(kLastNonVolatile))
        context_.diagnostics.report(Diag::VolatileInitial, decl.span, {fmt::format("{}", *high)});
      warn_of_system_variable(context_.program.ranges.of(kind), decl.span);
    }
  }

  // Told of the first one in the range.
  void warn_of_system_variable(const NumberRange& range, Span span) {
    for (const stdlib::SystemVariable& row : stdlib::system_variables())
      if (range.contains(row.number)) {
        context_.diagnostics
            .report(Diag::RawOverlap, span, {fmt::format("{}", row.number), std::string(row.compiler_name)})
            .notes.push_back({{},
                              fmt::format("the unit works with it; H{} and up are free",
                                          stdlib::kLastSystemVariable + 1)});
        return;
      }
  }

  // `130` and `H130` are the same.
  std::optional<int32_t> bound(const ast::Expr& expr) {
    uint32_t number = 0;
    if (const auto* name = std::get_if<ast::Name>(&expr.node); name && raw_number(name->text, number))
      return static_cast<int32_t>(number);
    return expressions_.constant(expr, "the bound of a range");
  }

  bool possible(int32_t low, int32_t high, Span span) {
    std::string reason;
    if (low < 0 || high < 0 || high >= context_.unit.variables)
      reason = fmt::format("{} has H0 to H{}", context_.unit.name, context_.unit.variables - 1);
    else if (low > high)
      reason = "the first number is the larger one";
    else if (low <= static_cast<int32_t>(kLastReservedVariable) &&
             high >= static_cast<int32_t>(stdlib::kFirstSystemVariable))
      reason =
          fmt::format("H{} to H{} are system variables", stdlib::kFirstSystemVariable, kLastReservedVariable);
    if (reason.empty()) return true;
    context_.diagnostics.report(Diag::BadRange, span,
                                {fmt::format("{}", low), fmt::format("{}", high), reason});
    return false;
  }

  // The three ranges among each other, as far as a pragma moved one of them.
  void check_ranges() {
    constexpr RangeKind kKinds[] = {RangeKind::Globals, RangeKind::Initials, RangeKind::Temporaries};
    for (size_t a = 0; a < 3; ++a) {
      for (size_t b = a + 1; b < 3; ++b) {
        const NumberRange& first = context_.program.ranges.of(kKinds[a]);
        const NumberRange& second = context_.program.ranges.of(kKinds[b]);
        const Span span = pragmas_[b].begin.valid() ? pragmas_[b] : pragmas_[a];
        if (!first.overlaps(second) || !span.begin.valid()) continue;
        context_.diagnostics.report(
            Diag::RangeOverlap, span,
            {fmt::format("{}", second.low), fmt::format("{}", second.high), pragma_name(kKinds[b]),
             fmt::format("{}", first.low), fmt::format("{}", first.high), pragma_name(kKinds[a])});
      }
    }
  }

  void check_overflow(RangeKind kind) {
    const Fill& fill = fills_[kind == RangeKind::Initials];
    if (!fill.overflow.begin.valid()) return;
    const NumberRange& range = context_.program.ranges.of(kind);
    std::bitset<kMaxNumbers> others;
    for (const Variable& variable : context_.scope.variables())
      if ((variable.storage == Storage::Initial) != (kind == RangeKind::Initials) ||
          variable.storage == Storage::Alias)
        for (uint32_t n = variable.number; n < variable.number + variable.type.size() && n < kMaxNumbers; ++n)
          others.set(n);
    context_.diagnostics.report(
        Diag::RangeOverflow, fill.overflow,
        {kind == RangeKind::Initials ? "initial" : "global",
         fmt::format("{}{}", fill.count == kHugeSize ? "at least " : "", fill.count),
         fmt::format("{}", range.low), fmt::format("{}", range.high), fmt::format("{}", range.size()),
         range_advice(kind, fill.count, context_.program.ranges, others, context_.unit)});
    context_.overflown = true;
  }

  Context& context_;
  ExpressionChecker expressions_;
  size_t functions_ = 0;
  Fill fills_[2];    // globals, initials
  Span pragmas_[3];  // by RangeKind
};

}  // namespace

bool Context::use_raw(uint32_t number, Span span, std::string_view name) {
  if (number >= unit.variables) {
    diagnostics.report(
        Diag::InvalidVariable, span,
        {std::string(name.substr(1)), std::string(unit.name), fmt::format("{}", unit.variables - 1)});
    return false;
  }
  raw_names.emplace(number, span);
  program.named.set(number);
  return true;
}

void declare(const ast::Program& program, Context& context) {
  context.tree = &program;
  Declarations(context).run(program);
}

bool Context::has_room(const Variable& variable) const {
  if (!overflown || variable.storage == Storage::Alias) return true;
  const auto& range =
      program.ranges.of(variable.storage == Storage::Initial ? RangeKind::Initials : RangeKind::Globals);
  return variable.number + variable.type.size() - 1 <= range.high;
}

void check_numbers(Context& context) {
  // Owner of each number; variables of one range never meet, those of two ranges may.
  std::map<uint32_t, const Variable*> owner;
  std::set<const Variable*> collided;
  for (const Variable& variable : context.scope.variables()) {
    if (!context.has_room(variable)) continue;
    for (uint32_t n = variable.number; n < variable.number + variable.type.size() && n < kMaxNumbers; ++n) {
      context.program.named.set(n);
      if (variable.storage == Storage::Alias) continue;
      const auto [at, fresh] = owner.emplace(n, &variable);
      if (fresh || !collided.insert(&variable).second) continue;
      const RangeKind kind = variable.storage == Storage::Initial ? RangeKind::Initials : RangeKind::Globals;
      context.diagnostics
          .report(Diag::RangeCollision, variable.span,
                  {variable.name, at->second->name, fmt::format("{}", n),
                   range_advice(kind, context.program.ranges.of(kind).size(), context.program.ranges,
                                context.program.named, context.unit)})
          .notes.push_back({at->second->span, fmt::format("'{}' is declared here", at->second->name)});
    }
  }
  for (const auto& [number, span] : context.raw_names) {
    const auto found = owner.find(number);
    if (found == owner.end()) continue;
    context.diagnostics.report(Diag::RawOverlap, span, {fmt::format("{}", number), found->second->name})
        .notes.push_back({found->second->span, fmt::format("'{}' is declared here", found->second->name)});
  }
}

}  // namespace ipos::compiler
