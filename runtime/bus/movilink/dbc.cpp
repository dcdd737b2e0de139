// Writes DBC: which messages there are, and their text.
#include "runtime/bus/movilink/dbc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/movilink/dbc_signals.hpp"

namespace ipos::runtime {
namespace {

constexpr const char* kNobody = "Vector__XXX";

using dbc::identifier;
using dbc::Signal;

struct Message {
  uint32_t id;
  std::string name;
  uint32_t bytes;
  std::string sender;
  std::set<std::string> receivers;
  std::vector<Signal> signals;
  int32_t cycle = 0;
  std::string comment;
};

class Writer {
 public:
  explicit Writer(const TelegramNames& names) : names_(names) {
    for (const UnitNames& unit : names.units) add_unit(unit);
    for (const ObjectNames& object : names.objects) add_object(object);
    std::stable_sort(messages_.begin(), messages_.end(),
                     [](const auto& a, const auto& b) { return a.id < b.id; });
  }

  std::string text() const {
    std::string out = "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_:";
    std::set<std::string> nodes;
    for (const UnitNames& unit : names_.units) nodes.insert(identifier(unit.name));
    for (const std::string& node : nodes) out += " " + node;
    out += "\n\n";
    for (const Message& message : messages_) out += message_text(message);
    for (const Message& message : messages_)
      out += fmt::format("CM_ BO_ {} \"{}, identifier {}\";\n", message.id, message.comment,
                         id_words(message.id));
    out += "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\nBA_DEF_DEF_ \"GenMsgCycleTime\" 0;\n";
    for (const Message& message : messages_)
      if (message.cycle > 0)
        out += fmt::format("BA_ \"GenMsgCycleTime\" BO_ {} {};\n", message.id, message.cycle);
    for (const Message& message : messages_)
      for (const Signal& signal : message.signals) out += values_text(message, signal);
    return out;
  }

 private:
  Message* find(uint32_t id) {
    for (Message& message : messages_)
      if (message.id == id) return &message;
    return nullptr;
  }

  void add_unit(const UnitNames& unit) {
    for (const TelegramType& type : kTelegrams) {
      if (!has_telegram(unit.settings, type.telegram)) continue;
      const bool input = !type.from_master;
      const uint8_t address = type.grouped ? unit.settings.group : unit.settings.address;
      const uint32_t id = sbus_identifier(type.telegram, address);
      if (Message* known = find(id)) {  // a group with several members, named by the first one
        known->receivers.insert(identifier(unit.name));
        continue;
      }
      const std::string whose = type.grouped ? fmt::format("group_{}", address) : unit.name;
      Message message{id,
                      identifier(fmt::format("{}_{}", kind_of(type), whose)),
                      type.parameter ? 8U : 6U,
                      input ? identifier(unit.name) : kNobody,
                      {},
                      type.parameter ? dbc::parameter_signals(unit) : dbc::process_signals(unit, input),
                      0,
                      std::string(type.text)};
      if (!input) message.receivers.insert(identifier(unit.name));
      messages_.push_back(std::move(message));
    }
  }

  static std::string kind_of(const TelegramType& type) {
    const std::string group = type.grouped ? "G" : "";
    if (type.parameter)
      return group + (type.from_master ? "request" : "response") +
             (type.known == TelegramKnown::Channel2 ? "_2" : "");
    if (!type.from_master) return "PI";
    return group + (type.telegram == Telegram::ProcessOutputSync ? "PO_sync" : "PO");
  }

  // Sender and receivers of one identifier are one message; the sender's names win.
  void add_object(const ObjectNames& object) {
    Message* message = find(object.id);
    if (message == nullptr) {
      messages_.push_back({object.id,
                           fmt::format("Object_{}", object.id),
                           object.format.length,
                           kNobody,
                           {},
                           dbc::object_signals(object),
                           0,
                           "variable telegram"});
      message = &messages_.back();
    }
    if (!object.sent) {
      message->receivers.insert(identifier(object.station));
      return;
    }
    if (message->sender != kNobody) return;
    message->sender = identifier(object.station);
    message->signals = dbc::object_signals(object);
    message->bytes = object.format.length;
    message->cycle = object.cycle;
  }

  static std::string values_text(const Message& message, const Signal& signal) {
    if (signal.values.empty()) return {};
    std::string text = fmt::format("VAL_ {} {}", message.id, signal.name);
    for (const auto& [value, name] : signal.values) text += fmt::format(" {} \"{}\"", value, name);
    return text + " ;\n";
  }

  static std::string message_text(const Message& message) {
    std::string text =
        fmt::format("BO_ {} {}: {} {}\n", message.id, message.name, message.bytes, message.sender);
    const std::string receivers =
        message.receivers.empty() ? kNobody : fmt::format("{}", fmt::join(message.receivers, ","));
    for (const Signal& signal : message.signals) {
      const std::string multiplex = signal.multiplexor   ? " M"
                                    : signal.multiplexed ? fmt::format(" m{}", *signal.multiplexed)
                                                         : "";
      const double span = std::exp2(static_cast<double>(signal.bits));
      const double low = signal.is_signed ? -span / 2 : 0;
      const double high = signal.is_signed ? span / 2 - 1 : span - 1;
      text += fmt::format(" SG_ {}{} : {}|{}@{}{} ({:.12g},0) [{:.12g}|{:.12g}] \"{}\" {}\n", signal.name,
                          multiplex, signal.start, signal.bits, signal.intel ? 1 : 0,
                          signal.is_signed ? '-' : '+', signal.factor, low * signal.factor,
                          high * signal.factor, signal.unit, receivers);
    }
    return text + "\n";
  }

  const TelegramNames& names_;
  std::vector<Message> messages_;
};

}  // namespace

std::string dbc_text(const TelegramNames& names) { return Writer(names).text(); }

}  // namespace ipos::runtime
