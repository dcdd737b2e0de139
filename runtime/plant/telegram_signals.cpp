// Fields of frames by table, words of PDOs by the mapping of their node, variables by the object that a program has
// defined: all looked up when the signal is read.
#include "runtime/plant/telegram_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/canopen/pdo.hpp"
#include "runtime/bus/movilink/identifiers.hpp"
#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/bus/movilink/variable_telegram.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kFieldWordBits = 16;
constexpr size_t kStandardDigits = 3, kExtendedDigits = 8;

enum class Message : uint8_t { Parameter, Nmt, Emergency, Sdo, ErrorControl, Bytes };

struct Field {
  Message message;
  std::string_view name;
  uint8_t byte, bytes;
  bool intel, is_signed;
  uint32_t mask;
  uint8_t bits;
  std::string_view meaning;
};

constexpr Field kFields[] = {
#define FIELD(message, name, byte, bytes, intel, is_signed, mask, bits, meaning) \
  {Message::message, name, byte, bytes, intel, is_signed, mask, bits, meaning},
#include "runtime/plant/telegram_fields.def"
};

int64_t number_in(const Frame& frame, const Field& field) {
  uint32_t number = 0;
  for (uint8_t n = 0; n < field.bytes; ++n) {
    const uint8_t at = field.intel ? static_cast<uint8_t>(field.byte + field.bytes - 1 - n)
                                   : static_cast<uint8_t>(field.byte + n);
    number = number << 8 | (at < frame.length ? frame.data[at] : 0U);
  }
  number &= field.mask;
  if (field.mask == 0x80) return number == 0 ? 0 : 1;
  return field.is_signed ? int64_t{static_cast<int32_t>(number)} : int64_t{number};
}

// One identifier of a line, for which signals are made.
class Telegrams {
 public:
  Telegrams(const Plant& plant, CanBus& bus, uint32_t id, bool extended, std::string text,
            std::vector<PlantSignal>& out)
      : plant_(plant), bus_(bus), id_(id), extended_(extended), text_(std::move(text)), out_(out) {}

  void add_fields(Message message) {
    for (const Field& field : kFields)
      if (field.message == message)
        add(field.name, field.meaning, field.bits,
            [&field](const Frame& frame) { return number_in(frame, field); });
  }

  void add_word(std::string_view name, size_t n) {  // of process data, from 0
    add(name, "process word", kFieldWordBits, [n](const Frame& frame) -> int64_t {
      const auto words = process_words(frame);
      return words ? (*words)[n] : 0;
    });
  }

  void add_count() {
    out_.push_back(signal("count", "frames since it is looked at", 0));
    out_.back().read = [&bus = bus_, id = id_, extended = extended_] {
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
        kFieldWordBits, [&plant = plant_, &line = bus_.line(), input, number](const Frame& frame) -> int64_t {
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
  static void for_each_pdo(const Plant& plant, const CanLine& line, Action action) {
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
  static VariableFormat format_of(const Plant& plant, const CanLine& line, const Frame& frame) {
    VariableFormat format{frame.length, VariableLayout::Motorola};
    for_each_object(plant, line, [&](const ObjectDefinition& object) {
      if (static_cast<uint32_t>(object.object) == frame.id) format = *object.format;
    });
    return format;
  }

  template <typename Action>
  static void for_each_object(const Plant& plant, const CanLine& line, Action action) {
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
  PlantSignal signal(std::string_view word, std::string_view meaning, size_t bits) const {
    PlantSignal made;
    made.station = bus_.name();
    made.name =
        fmt::format("{}.{:0{}X}.{}", bus_.name(), id_, extended_ ? kExtendedDigits : kStandardDigits, word);
    made.group = SignalGroup::Bus;
    made.meaning = fmt::format("{}{}{}", text_, text_.empty() ? "" : ": ", meaning);
    made.bits = bits;
    return made;
  }
  template <typename Read>
  void add(std::string_view word, std::string_view meaning, size_t bits, Read read) {
    out_.push_back(signal(word, meaning, bits));
    out_.back().read = [&bus = bus_, id = id_, extended = extended_, read]() -> int64_t {
      return read(bus.last_frames().of(id, extended).frame);
    };
  }

  const Plant& plant_;
  CanBus& bus_;
  uint32_t id_;
  bool extended_;
  std::string text_;
  std::vector<PlantSignal>& out_;
};

void add_movilink(const Plant& plant, CanBus& bus, const std::string& unit, const SlaveSettings& settings,
                  std::vector<PlantSignal>& out) {
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

void add_node(const Plant& plant, CanBus& bus, const std::string& unit, uint8_t node,
              std::vector<PlantSignal>& out) {
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

// What is there of a line, a signal once: several units may have one group address.
std::vector<PlantSignal> line_telegrams(const Plant& plant, CanBus& bus) {
  std::vector<PlantSignal> out;
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
  std::stable_sort(out.begin(), out.end(),
                   [](const PlantSignal& a, const PlantSignal& b) { return a.name < b.name; });
  out.erase(std::unique(out.begin(), out.end(),
                        [](const PlantSignal& a, const PlantSignal& b) { return a.name == b.name; }),
            out.end());
  return out;
}

std::vector<CanBus*> can_buses(const Plant& plant) {
  std::vector<CanBus*> buses;
  for (const auto& bus : plant.buses())
    if (auto* can = dynamic_cast<CanBus*>(bus.get())) buses.push_back(can);
  return buses;
}

// Every word that any identifier can have.
std::vector<PlantSignal> all_words(const Plant& plant, CanBus& bus, uint32_t id, bool extended) {
  std::vector<PlantSignal> out;
  Telegrams made(plant, bus, id, extended, "", out);
  made.add_count();
  made.add_fields(Message::Bytes);
  for (size_t n = 0; n < 2; ++n) made.add_variable(n);
  for (const bool input : {false, true})
    for (uint8_t n = 1; n <= canopen::objects::kProcessWords && !extended; ++n) made.add_mapped(input, n);
  return out;
}

}  // namespace

std::vector<PlantSignal> telegram_signals(const Plant& plant) {
  std::vector<PlantSignal> all;
  for (CanBus* bus : can_buses(plant))
    for (PlantSignal& signal : line_telegrams(plant, *bus)) all.push_back(std::move(signal));
  return all;
}

std::optional<PlantSignal> find_telegram_signal(const Plant& plant, std::string_view name) {
  for (CanBus* bus : can_buses(plant)) {
    if (!name.starts_with(bus->name() + ".")) continue;
    const std::string_view rest = name.substr(bus->name().size() + 1);
    const size_t digits = rest.find('.');
    if (digits != kStandardDigits && digits != kExtendedDigits) continue;
    uint32_t id = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + digits, id, 16);
    const bool extended = digits == kExtendedDigits;
    if (error != std::errc() || end != rest.data() + digits ||
        id >= (extended ? kExtendedIdLimit : kStandardIdLimit))
      continue;
    const std::string full = fmt::format("{}.{:0{}X}.{}", bus->name(), id, digits, rest.substr(digits + 1));
    if (auto found = find_among(line_telegrams(plant, *bus), full)) return found;
    if (auto found = find_among(all_words(plant, *bus, id, extended), full)) return found;
  }
  return std::nullopt;
}

std::vector<PlantSignal> match_telegram_signals(const Plant& plant, std::string_view pattern) {
  std::vector<PlantSignal> found;
  for (CanBus* bus : can_buses(plant))
    for (size_t dot = pattern.find('.'); dot != std::string_view::npos; dot = pattern.find('.', dot + 1)) {
      const std::string_view rest = pattern.substr(dot + 1);
      const size_t behind_id = rest.find('.');
      if (behind_id == std::string_view::npos || !matches(pattern.substr(0, dot), bus->name())) continue;
      const std::string_view ids = rest.substr(0, behind_id), words = rest.substr(behind_id + 1);
      const size_t before_bit = words.rfind('.');
      for (const PlantSignal& signal : line_telegrams(plant, *bus)) {
        const std::string_view own = std::string_view(signal.name).substr(bus->name().size() + 1);
        const std::string_view word = own.substr(own.find('.') + 1);
        if (!matches(ids, own.substr(0, own.find('.')))) continue;
        if (before_bit != std::string_view::npos && matches(words.substr(0, before_bit), word))
          for (size_t bit = 0; bit < bit_count(signal); ++bit)
            if (matches(words.substr(before_bit + 1), fmt::format("{}", bit)))
              found.push_back(bit_of(signal, bit));
        if (matches(words, word)) found.push_back(signal);
      }
      break;
    }
  return found;
}

}  // namespace ipos::runtime
