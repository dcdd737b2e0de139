// Writes DBC: which messages there are, and their text.
#include "runtime/bus/dbc/dbc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/canopen/dbc_messages.hpp"
#include "runtime/bus/log/unique_names.hpp"
#include "runtime/bus/movilink/dbc_signals.hpp"

namespace ipos::runtime {
namespace {

using dbc::identifier;
using dbc::kNobody;
using dbc::Message;
using dbc::Signal;

class Writer {
 public:
  explicit Writer(const CanLineNames& names) {
    for (const UnitNames& unit : names.movilink.units) add_unit(unit);
    for (const canopen::NodeName& node : names.nodes) add_node(node);
    for (const ObjectNames& object : names.movilink.objects) add_object(object);
    std::stable_sort(messages_.begin(), messages_.end(),
                     [](const auto& a, const auto& b) { return a.id < b.id; });
    UniqueNames unique(dbc::kLongestName);
    for (Message& message : messages_) {
      message.name = unique.of(fmt::format("{}", message.id), identifier(message.name));
      UniqueNames in_message(dbc::kLongestName);
      for (size_t n = 0; n < message.signals.size(); ++n) {
        Signal& signal = message.signals[n];
        signal.name = in_message.of(fmt::format("{}", n), signal.name);
      }
    }
  }

  std::string text() {
    std::string out = "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_:";
    std::set<std::string> nodes;
    for (const std::string& station : stations_) nodes.insert(node(station));
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
  // What a station is called here.
  const std::string& node(const std::string& station) { return nodes_.of(station, identifier(station)); }

  Message* find(uint32_t id) {
    for (Message& message : messages_)
      if (message.id == id) return &message;
    return nullptr;
  }

  void add_unit(const UnitNames& unit) {
    add_station(unit.name);
    for (const TelegramType& type : kTelegrams) {
      if (!has_telegram(unit.settings, type.telegram)) continue;
      const bool input = !type.from_master;
      const uint8_t address = type.grouped ? unit.settings.group : unit.settings.address;
      const uint32_t id = sbus_identifier(type.telegram, address);
      if (Message* known = find(id)) {  // a group with several members, named by the first one
        known->receivers.insert(unit.name);
        continue;
      }
      const std::string whose = type.grouped ? fmt::format("group_{}", address) : unit.name;
      Message message{id,
                      fmt::format("{}_{}", kind_of(type), whose),
                      type.parameter ? 8U : 6U,
                      input ? unit.name : kNobody,
                      {},
                      type.parameter ? dbc::parameter_signals(unit) : dbc::process_signals(unit, input),
                      0,
                      std::string(type.text)};
      if (!input) message.receivers.insert(unit.name);
      messages_.push_back(std::move(message));
    }
  }

  void add_station(const std::string& name) {
    if (std::find(stations_.begin(), stations_.end(), name) == stations_.end()) stations_.push_back(name);
  }

  void add_node(const canopen::NodeName& node) {
    add_station(node.name);
    for (Message& message : canopen::dbc_messages(node)) {
      if (Message* known = find(message.id))  // to all nodes
        known->receivers.merge(message.receivers);
      else
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
      message->receivers.insert(object.station);
      return;
    }
    if (message->sender != kNobody) return;
    message->sender = object.station;
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

  std::string message_text(const Message& message) {
    std::string text = fmt::format("BO_ {} {}: {} {}\n", message.id, message.name, message.bytes,
                                   message.sender == kNobody ? kNobody : node(message.sender));
    std::set<std::string> names;
    for (const std::string& station : message.receivers) names.insert(node(station));
    const std::string receivers = names.empty() ? kNobody : fmt::format("{}", fmt::join(names, ","));
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

  std::vector<std::string> stations_;
  UniqueNames nodes_{dbc::kLongestName};
  std::vector<Message> messages_;
};

}  // namespace

std::string dbc_text(const CanLineNames& names) { return Writer(names).text(); }

}  // namespace ipos::runtime
