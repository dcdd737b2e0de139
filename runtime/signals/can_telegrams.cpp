// CAN: fields of frames by table, words of PDOs by the mapping of their node, variables by the object that a program has
// defined: all looked up when the signal is read.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/canopen/pdo.hpp"
#include "runtime/bus/movilink/identifiers.hpp"
#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/bus/movilink/variable_telegram.hpp"
#include "runtime/signals/telegram_lines.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

using Message = TelegramMessage;

std::span<const uint8_t> data_of(const Frame& frame) { return std::span(frame.data).first(frame.length); }

// The signals that are made, and what each has in a frame where one is given.
struct Made {
  std::vector<Signal> signals;
  const Frame* said = nullptr;
  std::vector<int64_t> values;
};

// One identifier of a line, for which signals are made.
class Telegrams {
 public:
  Telegrams(const PlantParts& plant, CanBus& bus, uint32_t id, bool extended, std::string text, Made& out)
      : plant_(plant), bus_(bus), id_(id), extended_(extended), text_(std::move(text)), out_(out) {}

  void add_fields(Message message) {
    for (const TelegramField& field : telegram_fields())
      if (field.message == message)
        add(field.name, field.meaning, field.bits,
            [&field](const Frame& frame) { return number_in(data_of(frame), field); });
  }

  void add_word(std::string_view name, size_t n) {  // of process data, from 0
    add(name, "process word", kTelegramWordBits, [n](const Frame& frame) -> int64_t {
      const auto words = process_words(frame);
      return words ? (*words)[n] : 0;
    });
  }

  void add_count() {
    if (out_.said != nullptr) return;  // no frame carries it
    out_.signals.push_back(signal("count", "frames since it is looked at", 0));
    out_.signals.back().read = [&bus = bus_, id = id_, extended = extended_] {
      return static_cast<int64_t>(bus.last_frames().of(id, extended).count);
    };
  }

  // What DPointer (0) or DPointer + 1 gets.
  void add_variable(size_t n) {
    add(n == 0 ? "value1" : "value2", n == 0 ? "for the variable DPointer" : "for DPointer + 1", 0,
        [&plant = plant_, &line = bus_.line(), n](const Frame& frame) -> int64_t {
          const auto pair = frame_variables(frame, format_of(plant, line, frame));
          return !pair ? 0 : n == 0 ? pair->low : pair->high;
        });
  }

  // PO1 to PO10 or PI1 to PI10 of the PDO that a node has mapped to this identifier.
  void add_mapped(bool input, uint8_t number) {
    add(fmt::format("{}{}", input ? "PI" : "PO", number), "word of a PDO, by the mapping of its node",
        kTelegramWordBits,
        [&plant = plant_, &line = bus_.line(), input, number](const Frame& frame) -> int64_t {
          int64_t value = 0;
          for_each_pdo(plant, line, [&](uint32_t id, bool transmit, const canopen::Mapping& mapping) {
            canopen::Words words{};
            if (id == frame.id && transmit == input &&
                (canopen::unpack(mapping, frame.data, words) >> (number - 1) & 1) != 0)
              value = words[number - 1U];
          });
          return value;
        });
  }

  // `action(id, transmit, mapping)` for each PDO of the nodes on the line that is on.
  template <typename Action>
  static void for_each_pdo(const PlantParts& plant, const CanLine& line, Action action) {
    namespace objects = canopen::objects;
    for (const auto& station : plant.stations())
      for (const int number : {1, 2}) {
        const CanopenPort* port = std::as_const(*station).canopen(number);
        if (port == nullptr || &port->line() != &line || port->canopen() == nullptr) continue;
        const canopen::ObjectDictionary& dictionary = port->canopen()->dictionary();
        for (uint16_t pdo = 0; pdo < objects::kPdos; ++pdo)
          for (const bool transmit : {false, true}) {
            const auto index = [pdo](uint16_t first) { return static_cast<uint16_t>(first + pdo); };
            const uint32_t id = dictionary.value(
                index(transmit ? objects::kTransmitPdo : objects::kReceivePdo), objects::kCobId);
            if ((id & objects::kOff) != 0) continue;
            action(id & objects::kIdMask, transmit,
                   canopen::mapping_of(
                       dictionary, index(transmit ? objects::kTransmitMapping : objects::kReceiveMapping)));
          }
      }
  }

  // As the object with this identifier says, of whichever station; MOTOROLA in the frame's length where there is none.
  static VariableFormat format_of(const PlantParts& plant, const CanLine& line, const Frame& frame) {
    VariableFormat format{frame.length, VariableLayout::Motorola};
    for_each_object(plant, line, [&](const ObjectDefinition& object) {
      if (static_cast<uint32_t>(object.object) == frame.id) format = *object.format;
    });
    return format;
  }

  template <typename Action>
  static void for_each_object(const PlantParts& plant, const CanLine& line, Action action) {
    for (const auto& station : plant.stations())
      for (const int number : {1, 2}) {
        const auto of = [&](const auto* port) {
          if (port == nullptr || &port->line() != &line) return;
          for (const ObjectDefinition& object : port->objects().definitions())
            if (object.accepted) action(object);
        };
        of(std::as_const(*station).sbus(number));
        of(std::as_const(*station).canopen(number));
      }
  }

 private:
  Signal signal(std::string_view word, std::string_view meaning, size_t bits) const {
    return telegram_signal(bus_, id_text(id_, extended_), word,
                           fmt::format("{}{}{}", text_, text_.empty() ? "" : ": ", meaning), bits);
  }
  template <typename Read>
  void add(std::string_view word, std::string_view meaning, size_t bits, Read read) {
    if (out_.said != nullptr) out_.values.push_back(read(*out_.said));
    out_.signals.push_back(signal(word, meaning, bits));
    out_.signals.back().read = [&bus = bus_, id = id_, extended = extended_, read]() -> int64_t {
      return read(bus.last_frames().of(id, extended).frame);
    };
  }

  const PlantParts& plant_;
  CanBus& bus_;
  uint32_t id_;
  bool extended_;
  std::string text_;
  Made& out_;
};

void add_movilink(const PlantParts& plant, CanBus& bus, const std::string& unit, const SlaveSettings& settings,
                  Made& out) {
  for (const TelegramType& type : kTelegrams) {
    if ((type.known == TelegramKnown::Synchronous && !settings.synchronous) ||
        (type.known == TelegramKnown::Channel2 && !settings.second_channel))
      continue;
    const uint8_t address = type.grouped ? settings.group : settings.address;
    Telegrams made(plant, bus, sbus_identifier(type.telegram, address), false,
                   fmt::format("{} {} {}", type.text, type.from_master ? "to" : "of", unit), out);
    made.add_count();
    if (type.parameter)
      made.add_fields(Message::Parameter);
    else
      for (size_t n = 0; n < kSbusProcessWords; ++n)
        made.add_word(fmt::format("{}{}", type.from_master ? "PO" : "PI", n + 1), n);
  }
}

void add_node(const PlantParts& plant, CanBus& bus, const std::string& unit, uint8_t node,
              Made& out) {
  using canopen::Connection;
  for (const auto& [connection, message] : {std::pair{Connection::Emergency, Message::Emergency},
                                            {Connection::SdoRequest, Message::Sdo},
                                            {Connection::SdoResponse, Message::Sdo},
                                            {Connection::ErrorControl, Message::ErrorControl}}) {
    const canopen::ConnectionRow& row = canopen::row_of(connection);
    Telegrams made(plant, bus, canopen::identifier(connection, node), false,
                   fmt::format("{} {} {}", row.text, row.from_node ? "of" : "to", unit), out);
    made.add_count();
    made.add_fields(message);
  }
}

// What is there of a line; several units may have one group address.
void add_line(const PlantParts& plant, CanBus& bus, Made& out) {
  bool nodes = false;
  for (const auto& station : plant.stations())
    for (const int number : {1, 2}) {
      const std::string& name = station->config().name;
      const SbusPort* port = std::as_const(*station).sbus(number);
      if (port != nullptr && &port->line() == &bus.line())
        add_movilink(plant, bus, name, port->settings().slave, out);
      const CanopenPort* node = std::as_const(*station).canopen(number);
      if (node == nullptr || &node->line() != &bus.line()) continue;
      nodes = true;
      add_node(plant, bus, name, node->settings().canopen_address, out);
    }
  if (nodes) Telegrams(plant, bus, 0, false, "NMT", out).add_fields(Message::Nmt);
  Telegrams::for_each_pdo(
      plant, bus.line(), [&](uint32_t id, bool transmit, const canopen::Mapping& mapping) {
        Telegrams made(plant, bus, id, false, transmit ? "PDO of a node" : "PDO to a node", out);
        made.add_count();
        for (const canopen::Mapped& mapped : mapping)
          if (canopen::is_word(mapped)) made.add_mapped(transmit, mapped.address.sub);
      });
  Telegrams::for_each_object(plant, bus.line(), [&](const ObjectDefinition& object) {
    Telegrams made(plant, bus, static_cast<uint32_t>(object.object), false, "variable telegram", out);
    made.add_count();
    for (size_t n = 0; n < object.format->variables(); ++n) made.add_variable(n);
  });
}

// Each signal once.
std::vector<Signal> line_telegrams(const PlantParts& plant, CanBus& bus) {
  Made made;
  add_line(plant, bus, made);
  std::vector<Signal>& out = made.signals;
  std::stable_sort(out.begin(), out.end(),
                   [](const Signal& a, const Signal& b) { return a.name < b.name; });
  out.erase(std::unique(out.begin(), out.end(),
                        [](const Signal& a, const Signal& b) { return a.name == b.name; }),
            out.end());
  return std::move(out);
}

// Every word that any identifier can have.
std::vector<Signal> all_words(const PlantParts& plant, CanBus& bus, uint32_t id, bool extended) {
  Made out;
  Telegrams made(plant, bus, id, extended, "", out);
  made.add_count();
  made.add_fields(Message::Bytes);
  for (size_t n = 0; n < 2; ++n) made.add_variable(n);
  for (const bool input : {false, true})
    for (uint8_t n = 1; n <= canopen::objects::kProcessWords && !extended; ++n) made.add_mapped(input, n);
  return std::move(out.signals);
}

// The bytes of a frame of which nothing is known.
void add_bytes(const PlantParts& plant, CanBus& bus, const Frame& frame, Made& out) {
  Telegrams(plant, bus, frame.id, frame.extended, "", out).add_fields(Message::Bytes);
  out.signals.resize(std::min<size_t>(out.signals.size(), frame.length));
}

class CanTelegrams final : public TelegramLine {
 public:
  CanTelegrams(const PlantParts& plant, CanBus& bus) : plant_(plant), bus_(bus) {}

  const Bus& bus() const override { return bus_; }
  std::vector<Signal> listed() const override { return line_telegrams(plant_, bus_); }
  std::optional<std::string> identity(std::string_view text) const override {
    const auto id = number_of(text);
    return id ? std::optional(id_text(*id, text.size() == kExtendedIdDigits)) : std::nullopt;
  }
  std::vector<Signal> all_of(std::string_view identity) const override {
    return all_words(plant_, bus_, *number_of(identity), identity.size() == kExtendedIdDigits);
  }
  std::vector<TelegramValue> values_of(const HeardTelegram& telegram) const override {
    Frame frame(telegram.id, 0);
    frame.extended = telegram.extended;
    frame.length = static_cast<uint8_t>(std::min(telegram.bytes.size(), frame.data.size()));
    std::copy_n(telegram.bytes.begin(), frame.length, frame.data.begin());
    std::vector<TelegramValue> values;
    const std::string own = fmt::format("{}.{}.", bus_.name(), id_text(frame.id, frame.extended));
    const auto take = [&](const auto& add) {
      Made made;
      made.said = &frame;
      add(made);
      for (size_t n = 0; n < made.signals.size(); ++n) {
        Signal& signal = made.signals[n];
        const auto same = [&signal](const TelegramValue& known) { return known.signal.name == signal.name; };
        if (signal.name.starts_with(own) && std::none_of(values.begin(), values.end(), same))
          values.push_back({std::move(signal), made.values[n]});
      }
    };
    take([this](Made& made) { add_line(plant_, bus_, made); });
    if (values.empty()) take([&](Made& made) { add_bytes(plant_, bus_, frame, made); });
    return values;
  }

 private:
  static std::optional<uint32_t> number_of(std::string_view text) {
    if (text.size() != kStandardIdDigits && text.size() != kExtendedIdDigits) return std::nullopt;
    uint32_t id = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id, 16);
    const uint32_t limit = text.size() == kExtendedIdDigits ? kExtendedIdLimit : kStandardIdLimit;
    if (error != std::errc() || end != text.data() + text.size() || id >= limit) return std::nullopt;
    return id;
  }

  const PlantParts& plant_;
  CanBus& bus_;
};

}  // namespace

std::unique_ptr<TelegramLine> telegrams_of(const PlantParts& plant, CanBus& bus) {
  return std::make_unique<CanTelegrams>(plant, bus);
}

}  // namespace ipos::signals
