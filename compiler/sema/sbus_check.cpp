// Static check of SBus objects: cycle times (1053 1610 p. 54, IPOSplus p. 232), identifiers (1053 1610 p.
// 51), number of objects (1053 1610 p. 54-55).
#include "compiler/sema/sbus_check.hpp"

#include <fmt/format.h>

#include <map>
#include <string>
#include <utility>

#include "compiler/sema/call_graph.hpp"
#include "compiler/sema/command_writes.hpp"
#include "stdlib/unit_names.hpp"

namespace ipos::compiler {
namespace {

constexpr int32_t kSbus2 = 0x1000000;  // IPOSplus p. 320

enum class Known : uint8_t { Always, Synchronous, Channel2 };

struct Telegram {
  int32_t function;
  bool parameter;
  Known known;
};
constexpr Telegram kTelegrams[] = {
#define TELEGRAM(name, function, parameter, grouped, from_master, known, text) \
  {function, parameter, Known::known},
#include "stdlib/sbus_telegrams.def"
};

// The MOVILINK telegram, of a unit of this type with any address and setting, that has this identifier.
const Telegram* movilink_telegram(int32_t identifier, const stdlib::UnitType& unit) {
  for (const Telegram& telegram : kTelegrams) {
    if (telegram.known == Known::Synchronous && !unit.has(stdlib::Trait::SynchronousSbus)) continue;
    if (telegram.known == Known::Channel2 && !unit.has(stdlib::Trait::Sbus2)) continue;
    if (identifier < 1024 && telegram.function == identifier % 8 && telegram.parameter == (identifier >= 512))
      return &telegram;
  }
  return nullptr;
}

struct Definition {
  int32_t kind;
  uint32_t structure;  // its first variable
  Span span;
};

class SbusChecker {
 public:
  explicit SbusChecker(Context& context) : context_(context) {}

  void run() {
    const std::vector<bool> used = reachable(context_.graph, context_.program.main);
    for (size_t n = 0; n < used.size(); ++n)
      if (used[n])
        for (const checked::Expr* expr : context_.contents[n].calls) collect(*expr);
    for (const ConstantStore& store : context_.stores)
      for (const Definition& definition : definitions_) check_store(store, definition);
    check_counts();
  }

 private:
  // A structure is one object, however often the program defines it.
  void collect(const checked::Expr& expr) {
    const auto* call = std::get_if<checked::SystemCall>(&expr.node);
    if (call == nullptr || call->opcode != vm::Opcode::Scom) return;
    const Definition found{std::get<int32_t>(call->arguments[0]),
                           static_cast<uint32_t>(std::get<int32_t>(call->arguments[1])), expr.span};
    for (const Definition& known : definitions_)
      if (known.kind == found.kind && known.structure == found.structure) return;
    definitions_.push_back(found);
  }

  void check_store(const ConstantStore& store, const Definition& definition) {
    if (store.number == definition.structure) check_identifier(store);
    if (store.number == definition.structure + 1 && definition.kind == kTransmitCyclic) check_cycle(store);
  }

  void check_cycle(const ConstantStore& store) {
    if (context_.unit.objects_of(store.value) != nullptr) return;
    std::string allowed;
    for (const stdlib::ObjectClass& objects : context_.unit.objects)
      allowed += (allowed.empty() ? "" : ", or ") + stdlib::cycle_text(objects);
    warn(Diag::SbusCycle, store.span,
         {fmt::format("{}", store.value), std::string(context_.unit.name), std::move(allowed)});
  }

  void check_identifier(const ConstantStore& store) {
    int32_t value = store.value;
    if (context_.unit.has(stdlib::Trait::Sbus2)) value &= ~kSbus2;  // a negative one stays negative
    std::string reason;
    if (value < 0 || value > 2047) {
      reason = "does not exist; identifiers are 0 to 2047";
    } else if (value == 0) {
      reason = "is the sync telegram of units with factory setting";
    } else if (const Telegram* telegram = movilink_telegram(value, context_.unit)) {
      reason = fmt::format("belongs to the MOVILINK telegrams of address {}{}; those above 1023 are free",
                           value / 8 % 64, telegram->known == Known::Channel2 ? ", second channel" : "");
    }
    if (!reason.empty()) warn(Diag::SbusIdentifier, store.span, {fmt::format("{}", store.value), reason});
  }

  // The cycle time a definition gets, when the program has one constant for it.
  const ConstantStore* only_store(uint32_t number) const {
    const ConstantStore* only = nullptr;
    for (const ConstantStore& store : context_.stores) {
      if (store.number != number) continue;
      if (only != nullptr && only->value != store.value) return nullptr;
      only = &store;
    }
    return only;
  }

  void check_counts() {
    std::map<const stdlib::ObjectClass*, uint32_t> cyclic;
    uint32_t receive = 0;
    const stdlib::UnitType& unit = context_.unit;
    for (size_t n = 0; n < definitions_.size(); ++n) {
      const Definition& definition = definitions_[n];
      if (definition.kind == kReceive) {
        count(++receive, unit.receive_objects, "receive", definition, "");
      } else if (definition.kind == kTransmitCyclic) {
        const ConstantStore* cycle = only_store(definition.structure + 1);
        if (const stdlib::ObjectClass* like = cycle == nullptr ? nullptr : unit.objects_of(cycle->value))
          count(++cyclic[like], like->objects, fmt::format("transmit ({})", stdlib::cycle_text(*like)), definition,
                " (Result -2)");
      }
      for (size_t earlier = 0; earlier < n; ++earlier) same_identifier(definitions_[earlier], definition);
    }
  }

  void count(uint32_t number, uint32_t most, const std::string& kind, const Definition& definition,
             const char* result) {
    if (number <= most || most == 0) return;
    warn(Diag::SbusObjects, definition.span,
         {std::string(context_.unit.name), fmt::format("{}", most), kind, fmt::format("{}", number), result});
  }

  void same_identifier(const Definition& first, const Definition& second) {
    if (first.structure == second.structure) return;
    const ConstantStore* a = only_store(first.structure);
    const ConstantStore* b = only_store(second.structure);
    if (a != nullptr && b != nullptr && a->value == b->value)
      warn(Diag::SbusIdentifier, b->span,
           {fmt::format("{}", b->value), "is used by another object of this unit"});
  }

  void warn(Diag diag, Span span, std::vector<std::string> args) {
    // One store may serve several definitions; one message is enough.
    if (reported_.emplace(diag, span.begin.value).second)
      context_.diagnostics.report(diag, span, std::move(args));
  }

  Context& context_;
  std::vector<Definition> definitions_;
  std::set<std::pair<Diag, uint32_t>> reported_;
};

}  // namespace

void check_sbus_objects(Context& context) { SbusChecker(context).run(); }

}  // namespace ipos::compiler
