// The members are found by their names in the standard structures, their values among the constants the
// program assigns.
#include "compiler/sema/watched.hpp"

#include <algorithm>

#include "compiler/sema/expressions.hpp"
#include "vm/isa/blocks.hpp"

namespace ipos::compiler {
namespace {

// A member with a number. `variables` the unit goes on looking at from there, 0: it does so at the call only.
struct NumberMember {
  std::string_view structure;
  std::string_view member;  // or how the names of several begin
  uint32_t variables;
  const char* who;
};
constexpr NumberMember kMembers[] = {
    {"MOVLNK", "DPointer", 0, ""},
    {"SCTRCYCL", "DPointer", 2, "the SBus sends it"},
    {"SCTRACYCL", "DPointer", 0, ""},
    {"SCREC", "DPointer", 2, "the SBus receives it"},
    {"VARINT", "SrcVar", 1, "a variable interrupt watches it"},
    {"GSCAM", "SourceVar", 0, ""},
    {"GSCAM", "DestVar", 0, ""},
    {"GSCAM_EXT", "CamDestination", 1, "the cam controller writes it"},
    {"GSCAM_EXT", "CamData", 10, "the cam controller reads it"},
};

class Finder {
 public:
  explicit Finder(const Context& context) : context_(context) {}

  Watched run(const std::vector<bool>& used) {
    const auto each = [&](const auto& part, auto visit) {
      for (size_t n = 0; n < used.size(); ++n)
        if (used[n])
          for (const checked::Expr* expr : context_.contents[n].*part) visit(*expr);
    };
    each(&Contents::calls, [&](const checked::Expr& expr) {
      if (const auto* call = std::get_if<checked::SystemCall>(&expr.node)) look(*call, expr.span);
    });
    if (found_.empty()) return std::move(out_);
    each(&Contents::expressions, [&](const checked::Expr& expr) {
      const auto* assign = std::get_if<checked::Assign>(&expr.node);
      if (assign == nullptr || assign->target.offset != nullptr) return;
      const auto number = static_cast<uint32_t>(assign->target.number);
      const bool looked_at = found_.contains(number) || found_.contains(number + 1);
      if (looked_at && (assign->op || constant_value(assign->value) == nullptr)) computed_.insert(number);
    });
    for (const ConstantStore& store : context_.stores)
      if (found_.contains(store.number)) constants_[store.number].push_back(&store);
    for (const auto& [number, place] : found_) enter(number, place);
    return std::move(out_);
  }

 private:
  struct Member {
    const NumberMember* row;
    Span call;
  };

  void look(const checked::SystemCall& call, Span span) {
    int32_t keyword = vm::kAnyKeyword;
    const vm::OpcodeInfo& command = vm::info(call.opcode);
    for (size_t n = 0; n < call.arguments.size(); ++n)
      if (command.operands[n].kind == vm::OperandKind::Keyword)
        keyword = std::get<int32_t>(call.arguments[n]);
    for (size_t n = 0; n < call.arguments.size(); ++n) {
      const int32_t* first = std::get_if<int32_t>(&call.arguments[n]);
      if (first == nullptr || command.operands[n].kind != vm::OperandKind::Variable) continue;
      const auto blocks = vm::blocks_of(call.opcode, n, keyword);
      for (const vm::BlockInfo& block : blocks)
        for (const NumberMember& row : kMembers)
          if (row.structure == block.type && (blocks.size() == 1 || may_be(block, *first)))
            add(row, static_cast<uint32_t>(*first), span);
    }
  }

  // Where several types may stand, the declaration tells which it is.
  bool may_be(const vm::BlockInfo& block, int32_t number) const {
    for (const Variable& variable : context_.scope.variables())
      if (variable.number == static_cast<uint32_t>(number) && variable.type.structure != nullptr)
        return variable.type.structure->name == block.type;
    return true;
  }

  void add(const NumberMember& row, uint32_t first, Span span) {
    for (const StructMember& member : context_.scope.find_type(row.structure)->members) {
      if (!member.names.front().starts_with(row.member)) continue;
      out_.members.insert(first + member.offset);
      if (row.variables != 0) found_.emplace(first + member.offset, Member{&row, span});
    }
  }

  void enter(uint32_t number, const Member& place) {
    const auto known = constants_.find(number);
    if (known == constants_.end() || computed_.contains(number)) {
      if (!place.row->member.starts_with("Cam")) out_.anywhere = Watch{place.row->who, place.call};
      if (known == constants_.end()) return;
    }
    const uint32_t variables = place.row->variables == 2 && is_short(number - 1) ? 1 : place.row->variables;
    for (const ConstantStore* store : known->second)
      for (uint32_t n = 0; n < variables; ++n)
        out_.variables.emplace(static_cast<uint32_t>(store->value) + n, Watch{place.row->who, store->span});
  }

  // A telegram of 4 bytes and less has one variable; its length stands before the number of the data.
  bool is_short(uint32_t format) const {
    constexpr int32_t kLength = 0xFF, kBytesOfOne = 4;
    bool any = false;
    for (const ConstantStore& store : context_.stores) {
      if (store.number != format) continue;
      if ((store.value & kLength) > kBytesOfOne) return false;
      any = true;
    }
    return any && !computed_.contains(format);
  }

  const Context& context_;
  std::map<uint32_t, Member> found_;
  std::set<uint32_t> computed_;  // those of them with a value that is none of the constants
  std::unordered_map<uint32_t, std::vector<const ConstantStore*>> constants_;
  Watched out_;
};

}  // namespace

Watched find_watched(const Context& context, const std::vector<bool>& used) {
  return Finder(context).run(used);
}

}  // namespace ipos::compiler
