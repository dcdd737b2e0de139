// Writes DBC. Bit numbers: 8 * byte + bit, bit 7 the highest. A big-endian signal is named by its highest
// bit, a little-endian one by its lowest.
#include "runtime/bus/movilink/dbc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

namespace ipos::runtime {
namespace {

constexpr size_t kLongestName = 32;
constexpr const char* kNobody = "Vector__XXX";

std::string identifier(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const bool good = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (good)
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0) name.insert(0, "_");
  return name.size() > kLongestName ? name.substr(0, kLongestName) : name;
}

struct Signal {
  std::string name;
  uint32_t start;
  uint32_t bits;
  bool intel;
  bool is_signed;
  double factor = 1;
  std::string unit;
};

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

// DPointer carries the low-order bytes, DPointer + 1 those beyond the fourth. What is shorter than a variable
// is filled with zeros on reception, so it has no sign.
std::vector<Signal> object_signals(const ObjectNames& object) {
  const uint32_t length = object.format.length;
  const bool intel = object.format.layout == VariableLayout::Intel;
  const uint32_t low_bytes = std::min(length, 4U);
  const uint32_t high_bytes = length - low_bytes;
  std::vector<Signal> signals;
  if (low_bytes > 0)
    signals.push_back({identifier(object.variables[0]), intel ? 0 : 8 * high_bytes + 7, 8 * low_bytes, intel,
                       low_bytes == 4, 1, ""});
  if (high_bytes > 0)
    signals.push_back(
        {identifier(object.variables[1]), intel ? 32U : 7U, 8 * high_bytes, intel, high_bytes == 4, 1, ""});
  if (signals.size() == 2 && signals[0].name == signals[1].name) signals[1].name = "DPointer_1";
  return signals;
}

std::vector<Signal> process_signals(const UnitNames& unit, bool input) {
  std::vector<Signal> signals;
  for (uint32_t n = 0; n < 3; ++n) {
    const uint8_t code = (input ? unit.input : unit.output)[n];
    const ProcessWordScale scale = process_word_scale(input, code);
    const std::string_view name = unit.unit == nullptr ? "" : process_word_name(*unit.unit, input, code);
    const double factor = scale.denominator == 0
                              ? 1
                              : static_cast<double>(scale.numerator) / static_cast<double>(scale.denominator);
    signals.push_back({identifier(fmt::format("{}{}_{}", input ? "PI" : "PO", n + 1, name)), 16 * n + 7, 16,
                       false, scale.is_signed && scale.denominator != 0, factor, std::string(scale.unit)});
  }
  return signals;
}

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
      out += fmt::format("CM_ BO_ {} \"{}\";\n", message.id, message.comment);
    out += "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\nBA_DEF_DEF_ \"GenMsgCycleTime\" 0;\n";
    for (const Message& message : messages_)
      if (message.cycle > 0)
        out += fmt::format("BA_ \"GenMsgCycleTime\" BO_ {} {};\n", message.id, message.cycle);
    return out;
  }

 private:
  Message* find(uint32_t id) {
    for (Message& message : messages_)
      if (message.id == id) return &message;
    return nullptr;
  }

  void add_unit(const UnitNames& unit) {
    for (const Telegram telegram : {Telegram::ProcessOutput, Telegram::ProcessInput,
                                    Telegram::ProcessOutputSync, Telegram::GroupProcessOutput}) {
      if (!has_telegram(unit.settings, telegram)) continue;
      const TelegramType& type = telegram_type(telegram);
      const bool input = !type.from_master;
      const uint8_t address = type.grouped ? unit.settings.group : unit.settings.address;
      const uint32_t id = sbus_identifier(telegram, address);
      if (Message* known = find(id)) {  // a group with several members, named by the first one
        known->receivers.insert(identifier(unit.name));
        continue;
      }
      const char* kind = input                                 ? "PI"
                         : type.grouped                        ? "GPO"
                         : telegram == Telegram::ProcessOutput ? "PO"
                                                               : "PO_sync";
      const std::string whose = type.grouped ? fmt::format("group_{}", address) : unit.name;
      Message message{id, identifier(fmt::format("{}_{}", kind, whose)),
                      6,  input ? identifier(unit.name) : kNobody,
                      {}, process_signals(unit, input),
                      0,  std::string(type.text)};
      if (!input) message.receivers.insert(identifier(unit.name));
      messages_.push_back(std::move(message));
    }
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
                           object_signals(object),
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
    message->signals = object_signals(object);
    message->bytes = object.format.length;
    message->cycle = object.cycle;
  }

  static std::string message_text(const Message& message) {
    std::string text =
        fmt::format("BO_ {} {}: {} {}\n", message.id, message.name, message.bytes, message.sender);
    const std::string receivers =
        message.receivers.empty() ? kNobody : fmt::format("{}", fmt::join(message.receivers, ","));
    for (const Signal& signal : message.signals) {
      const double span = std::exp2(static_cast<double>(signal.bits));
      const double low = signal.is_signed ? -span / 2 : 0;
      const double high = signal.is_signed ? span / 2 - 1 : span - 1;
      text += fmt::format(" SG_ {} : {}|{}@{}{} ({:.12g},0) [{:.12g}|{:.12g}] \"{}\" {}\n", signal.name, signal.start,
                          signal.bits, signal.intel ? 1 : 0, signal.is_signed ? '-' : '+', signal.factor,
                          low * signal.factor, high * signal.factor, signal.unit, receivers);
    }
    return text + "\n";
  }

  const TelegramNames& names_;
  std::vector<Message> messages_;
};

}  // namespace

std::string dbc_text(const TelegramNames& names) { return Writer(names).text(); }

}  // namespace ipos::runtime
