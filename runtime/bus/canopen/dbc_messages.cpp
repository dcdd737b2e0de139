// All numbers low byte first.
#include "runtime/bus/canopen/dbc_messages.hpp"

#include <fmt/format.h>

#include <utility>

#include "runtime/bus/canopen/emergency.hpp"
#include "runtime/bus/canopen/nmt.hpp"

namespace ipos::runtime::canopen {
namespace {

using dbc::Message;
using dbc::Signal;

Signal number(std::string name, uint32_t byte, uint32_t bytes) {
  return {std::move(name), 8 * byte, 8 * bytes, true};
}

struct NamedValue {
  int32_t value;
  std::string_view text;
};
constexpr NamedValue kStateTexts[] = {
#define NMT_STATE(name, code, text) {code, text},
#include "runtime/bus/canopen/nmt_commands.def"
};
constexpr NamedValue kCommandTexts[] = {
#define NMT_COMMAND(name, code, text) {code, text},
#include "runtime/bus/canopen/nmt_commands.def"
};
Signal with_values(Signal signal, std::span<const NamedValue> values) {
  for (const NamedValue& value : values) signal.values.emplace_back(value.value, value.text);
  return signal;
}

class Collector {
 public:
  explicit Collector(const NodeName& name)
      : name_(name), dictionary_(name.dictionary ? *name.dictionary : ObjectDictionary(name.node)) {}

  std::vector<Message> run() {
    to_all(identifier(Connection::Nmt), "NMT", 2,
           {with_values(number("Command", 0, 1), kCommandTexts), number("Node", 1, 1)});
    to_all(dictionary_.value(objects::kSyncId) & objects::kIdMask, "SYNC", 0, {});
    emergency();
    for (uint8_t n = 0; n < objects::kPdos; ++n)
      for (const bool transmit : {true, false}) pdo(n, transmit);
    const std::vector<Signal> sdo{number("Command", 0, 1), number("Index", 1, 2), number("Subindex", 3, 1),
                                  number("Data", 4, 4)};
    add(Connection::SdoResponse, "SDO_response", 8, sdo);
    add(Connection::SdoRequest, "SDO_request", 8, sdo);
    Signal state = with_values(number("State", 0, 1), kStateTexts);
    state.bits = 7;
    add(Connection::ErrorControl, "Life", 1, {state, {"Toggle", 7, 1, true}});
    return std::move(messages_);
  }

 private:
  void add(uint32_t id, bool from_node, std::string_view what, uint32_t bytes, std::vector<Signal> signals,
           std::string_view comment) {
    Message& message = messages_.emplace_back();
    message.id = id;
    message.name = fmt::format("{}_{}", what, name_.name);
    message.bytes = bytes;
    message.signals = std::move(signals);
    message.comment = comment;
    if (from_node)
      message.sender = name_.name;
    else
      message.receivers.insert(name_.name);
  }
  void add(Connection connection, std::string_view what, uint32_t bytes, std::vector<Signal> signals) {
    const ConnectionRow& row = row_of(connection);
    add(identifier(connection, name_.node), row.from_node, what, bytes, std::move(signals), row.text);
  }
  void to_all(uint32_t id, std::string_view what, uint32_t bytes, std::vector<Signal> signals) {
    add(id, false, what, bytes, std::move(signals), what);
    messages_.back().name = what;
  }

  void emergency() {
    const uint32_t cob_id = dictionary_.value(objects::kEmergencyId);
    if ((cob_id & objects::kOff) != 0) return;
    Signal code = number("Error_code", 0, 2);
    code.values.emplace_back(0, "gone");
    for (const EmergencyRow& row : kEmergencies) code.values.emplace_back(row.code, row.text);
    add(cob_id & objects::kIdMask, true, "EMCY", 8,
        {code, number("Error_register", 2, 1), number("Status_word_1", 4, 2)}, "EMCY");
  }

  // One that is on, by what is mapped to it.
  void pdo(uint8_t n, bool transmit) {
    const auto index = [n](uint16_t first) { return static_cast<uint16_t>(first + n); };
    const uint32_t cob_id =
        dictionary_.value(index(transmit ? objects::kTransmitPdo : objects::kReceivePdo), objects::kCobId);
    if ((cob_id & objects::kOff) != 0) return;
    const Mapping mapping =
        mapping_of(dictionary_, index(transmit ? objects::kTransmitMapping : objects::kReceiveMapping));
    std::vector<Signal> signals;
    uint32_t byte = 0;
    for (const Mapped& mapped : mapping) {
      if (is_word(mapped)) {
        const bool input = mapped.address.index == objects::kInput;
        const WordAssignment& words = input ? name_.input : name_.output;
        const size_t word = mapped.address.sub - 1U;
        dbc::add_word(signals, entry_name(mapped.address), {byte, byte + 1}, name_.unit, input,
                      word < words.size() ? words[word] : uint8_t{0});
      }
      byte += mapped.bits / 8;
    }
    const std::string what = fmt::format("{}PDO{}", transmit ? "T" : "R", n + 1);
    add(cob_id & objects::kIdMask, transmit, what, byte, std::move(signals), what);
  }

  const NodeName& name_;
  const ObjectDictionary dictionary_;
  std::vector<Message> messages_;
};

}  // namespace

std::vector<Message> dbc_messages(const NodeName& node) { return Collector(node).run(); }

}  // namespace ipos::runtime::canopen
