// Static check of SBus objects: cycle times (1053 1610 p. 54, IPOSplus p. 232), identifiers (1053 1610 p.
// 51), number of objects (1053 1610 p. 54-55).
#include "compiler/sema/sbus_check.hpp"

#include <fmt/format.h>

#include "compiler/sema/call_graph.hpp"
#include "compiler/sema/walk.hpp"

namespace ipos::compiler {
namespace {

constexpr int32_t kTransmitCyclic = 1;  // keywords.def, set scom
constexpr int32_t kReceive = 3;
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
const Telegram* movilink_telegram(int32_t identifier, stdlib::Generation generation) {
  for (const Telegram& telegram : kTelegrams) {
    if (telegram.known == Known::Synchronous && generation == stdlib::Generation::M07) continue;
    if (telegram.known == Known::Channel2 && generation != stdlib::Generation::B) continue;
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
    const std::vector<bool> used = reachable(call_graph(context_.program), context_.program.main);
    for (size_t n = 0; n < used.size(); ++n)
      if (used[n])
        checked::walk(*context_.program.functions[n].body, [&](const checked::Expr& e) { collect(e); });
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
    const bool fast = context_.unit.fast_objects > 0;
    const int32_t value = store.value;
    if (fast && value >= 1 && value <= 9) return;
    if (value >= 10 && value <= 65530 && value % 10 == 0) return;
    warn(Diag::SbusCycle, store.span,
         {fmt::format("{}", value), std::string(context_.unit.name),
          fast ? "1 to 9 ms, or 10 to 65530 ms in steps of 10" : "10 to 65530 ms in steps of 10"});
  }

  void check_identifier(const ConstantStore& store) {
    int32_t value = store.value;
    if (context_.unit.generation == stdlib::Generation::B) value &= ~kSbus2;  // a negative one stays negative
    std::string reason;
    if (value < 0 || value > 2047) {
      reason = "does not exist; identifiers are 0 to 2047";
    } else if (value == 0) {
      reason = "is the sync telegram of units with factory setting";
    } else if (const Telegram* telegram = movilink_telegram(value, context_.unit.generation)) {
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
    uint32_t fast = 0;
    uint32_t slow = 0;
    uint32_t receive = 0;
    const stdlib::UnitType& unit = context_.unit;
    for (size_t n = 0; n < definitions_.size(); ++n) {
      const Definition& definition = definitions_[n];
      if (definition.kind == kReceive) {
        count(++receive, unit.receive_objects, "receive", definition, "");
      } else if (definition.kind == kTransmitCyclic) {
        const ConstantStore* cycle = only_store(definition.structure + 1);
        if (cycle != nullptr && cycle->value < 10)
          count(++fast, unit.fast_objects, "transmit (1 to 9 ms)", definition, " (Result -2)");
        else if (cycle != nullptr)
          count(++slow, unit.slow_objects, "transmit (from 10 ms)", definition, " (Result -2)");
      }
      for (size_t earlier = 0; earlier < n; ++earlier) same_identifier(definitions_[earlier], definition);
    }
  }

  void count(uint32_t number, uint32_t most, const char* kind, const Definition& definition,
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
