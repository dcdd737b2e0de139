// A plant opened by the C functions, and its telegrams as the manuals print them: "523 # 31 00 20 7E 00 00 00 00" on an
// SBus, "02 01 05 00 06 3A 98 01 F4" on an RS-485 line. A test with it can do what a user can, and nothing else.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "tests/runtime/library/opened_plant.hpp"

namespace ipos::tests {

using Texts = std::vector<std::string>;
using Bytes = std::vector<uint8_t>;

inline constexpr int64_t kMs = 1'000'000;
inline constexpr int64_t kUs = 1'000;

inline Bytes bytes_of(const std::string& text) {
  Bytes bytes;
  for (size_t at = 0; at + 1 < text.size(); at += 3)
    bytes.push_back(static_cast<uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16)));
  return bytes;
}
inline std::string text_of(const uint8_t* bytes, size_t length) {
  std::string text;
  for (size_t n = 0; n < length; ++n) {
    char two[4];
    std::snprintf(two, sizeof two, "%02X", bytes[n]);
    text += (n == 0 ? "" : " ") + std::string(two);
  }
  return text;
}
// A telegram with the block check that 1053 1610 p. 25 prescribes: the exclusive-or of all characters.
inline std::string with_check(const std::string& text) {
  Bytes bytes = bytes_of(text);
  uint8_t check = 0;
  for (const uint8_t byte : bytes) check = static_cast<uint8_t>(check ^ byte);
  bytes.push_back(check);
  return text_of(bytes.data(), bytes.size());
}
inline std::string frame_text(uint32_t id, const std::string& bytes) {
  return std::to_string(id) + " #" + (bytes.empty() ? "" : " " + bytes);
}
inline std::string word_text(int word) {
  char text[8];
  std::snprintf(text, sizeof text, "%02X %02X", word >> 8 & 0xFF, word & 0xFF);
  return text;
}
inline std::string value_text(int64_t value) {
  return word_text(static_cast<int>(value >> 16 & 0xFFFF)) + " " +
         word_text(static_cast<int>(value & 0xFFFF));
}

// Parts of a plant file. `keys` are lines of the [[station]], `parameters` those of its [station.parameters].
inline std::string can_bus(const std::string& more = "") {
  return "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n" + more;
}
inline std::string serial_bus(const std::string& name = "line", const std::string& more = "") {
  return "[[bus]]\nname = \"" + name + "\"\nkind = \"rs485\"\n" + more;
}
inline std::string unit_on(const std::string& keys, const std::string& name, const std::string& unit,
                           const std::string& parameters, const std::string& more = "") {
  return "[[station]]\nname = \"" + name + "\"\nunit = \"" + unit + "\"\n" + keys + "[station.parameters]\n" +
         parameters + more;
}
inline std::string on_sbus(const std::string& name, const std::string& unit, const std::string& parameters,
                           const std::string& more = "") {
  return unit_on("sbus = \"sbus\"\n", name, unit, parameters, more);
}
inline std::string on_line(const std::string& name, const std::string& unit, const std::string& parameters,
                           const std::string& more = "") {
  return unit_on("rs485 = \"line\"\n", name, unit, parameters, more);
}
inline constexpr const char* kEnabled = "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";

struct HeardFrame {
  std::string text;
  int64_t time;        // of its end
  std::string sender;  // name of the station
};
struct HeardTelegram {
  std::string text;
  int64_t start, end;
  bool valid;
  std::string words;
};

class Talk {
 public:
  // `commands_a_ms` of every task; 0: as the unit has it.
  explicit Talk(const std::string& plant, const std::string& program = "", uint32_t commands_a_ms = 0)
      : opened_(plant, program, unrecorded(commands_a_ms)) {}

  int64_t now() const {
    int64_t time = 0;
    EXPECT_EQ(ipos_plant_time(plant(), &time), IPOS_PLANT_OK);
    return time;
  }
  void run_to(int64_t time) const {
    EXPECT_EQ(ipos_plant_run(plant(), time), IPOS_PLANT_OK) << opened_.message();
  }
  void pass(int64_t time) const { run_to(now() + time); }
  uint32_t bus(const char* name) const {
    uint32_t number = 0;
    EXPECT_EQ(ipos_plant_bus(plant(), name, &number), IPOS_PLANT_OK) << opened_.message();
    return number;
  }
  uint32_t station(const char* name) const {
    uint32_t number = 0;
    EXPECT_EQ(ipos_plant_station(plant(), name, &number), IPOS_PLANT_OK) << opened_.message();
    return number;
  }

  // What a station has: "P130", "PO1", "speed", "H420", "DI00".
  int64_t value(const char* of, const char* name) const { return opened_.value(signal(of, name)); }
  std::string text(const char* of, const char* name) const { return opened_.text(signal(of, name)); }
  void set(const char* of, const char* name, int64_t to) const {
    EXPECT_EQ(ipos_plant_write(plant(), signal(of, name), to), IPOS_PLANT_OK) << opened_.message();
  }
  void power(const char* of, bool on) const {
    EXPECT_EQ(ipos_plant_power(plant(), station(of), on), IPOS_PLANT_OK);
  }
  // Times the journal says it.
  int told(const std::string& words) const {
    int count = 0;
    ipos_plant_entry entry{};
    for (size_t n = 0; ipos_plant_journal_at(plant(), n, &entry) == IPOS_PLANT_OK; ++n)
      count += std::string(entry.text).find(words) != std::string::npos ? 1 : 0;
    return count;
  }

  // --- an SBus

  void send(const ipos_plant_frame& frame, const char* on = "sbus") const {
    EXPECT_EQ(ipos_plant_send(plant(), bus(on), &frame, nullptr), IPOS_PLANT_OK) << opened_.message();
  }
  void send(const std::string& text, const char* on = "sbus") const {
    ipos_plant_frame frame{};
    frame.id = static_cast<uint32_t>(std::strtoul(text.c_str(), nullptr, 10));
    const size_t at = text.find('#');
    const Bytes bytes = at + 2 < text.size() ? bytes_of(text.substr(at + 2)) : Bytes{};
    frame.length = static_cast<uint8_t>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), frame.data);
    send(frame, on);
  }
  // The frames of others since the last call, and the time at which the last one of ours had ended.
  std::vector<HeardFrame> heard(const char* on = "sbus") {
    std::vector<HeardFrame> frames;
    for (const ipos_plant_frame& frame : all_frames(bus(on))) {
      if ((frame.flags & IPOS_PLANT_ERROR) != 0) continue;
      if ((frame.flags & IPOS_PLANT_OWN) != 0) {
        sent_ = frame.time;
        continue;
      }
      const char* sender = "";
      EXPECT_EQ(ipos_plant_node_name(plant(), bus(on), frame.sender, &sender), IPOS_PLANT_OK);
      frames.push_back({frame_text(frame.id, text_of(frame.data, frame.length)), frame.time, sender});
    }
    return frames;
  }
  int64_t sent() const { return sent_; }
  // The frames of others within 20 ms.
  Texts ask(const std::string& frame, int64_t wait = 20 * kMs) {
    heard();
    send(frame);
    return answers(wait);
  }
  Texts ask(const ipos_plant_frame& frame) {
    heard();
    send(frame);
    return answers(20 * kMs);
  }
  Texts answers(int64_t wait) {
    pass(wait);
    Texts texts;
    last_ = heard();
    for (const HeardFrame& frame : last_) texts.push_back(frame.text);
    return texts;
  }
  const std::vector<HeardFrame>& last() const { return last_; }

  // --- an RS-485 line

  void serial_send(const std::string& text, const char* on = "line") const {
    const Bytes bytes = bytes_of(text);
    EXPECT_EQ(ipos_plant_serial_send(plant(), bus(on), bytes.data(), bytes.size()), IPOS_PLANT_OK)
        << opened_.message();
  }
  std::vector<HeardTelegram> serial_heard(const char* on = "line") const {
    std::vector<HeardTelegram> all;
    ipos_plant_telegram heard{};
    while (ipos_plant_serial_receive(plant(), bus(on), &heard) == IPOS_PLANT_OK)
      all.push_back({text_of(heard.bytes, heard.length), heard.start, heard.end, heard.valid, heard.text});
    return all;
  }
  // Sends octets as they are, after a pause of 10 ms; what is heard within 80 ms, without them.
  Texts serial_ask_raw(const std::string& text, const char* on = "line") {
    pass(10 * kMs);
    serial_heard(on);
    ipos_plant_bus_info info{};
    EXPECT_EQ(ipos_plant_bus_at(plant(), bus(on), &info), IPOS_PLANT_OK);
    const int64_t sent = now() + static_cast<int64_t>(text.size() + 1) / 3 * 11 * 1'000'000'000 / info.baud;
    serial_send(text, on);
    pass(80 * kMs);
    telegrams_ = serial_heard(on);
    Texts texts;
    for (const HeardTelegram& heard : telegrams_)
      if (heard.start >= sent) texts.push_back(heard.text);
    return texts;
  }
  // The same with the block check, which is left out of the answers, too.
  Texts serial_ask(const std::string& text, const char* on = "line") {
    Texts texts = serial_ask_raw(with_check(text), on);
    for (std::string& answer : texts) {
      EXPECT_EQ(with_check(answer.substr(0, answer.size() - 3)), answer);
      answer.resize(answer.size() - 3);
    }
    return texts;
  }
  const std::vector<HeardTelegram>& telegrams() const {
    return telegrams_;
  }  // of the last question, with itself

  const OpenedPlant& opened() const { return opened_; }
  ipos_plant* plant() const { return opened_.plant; }

 private:
  std::vector<ipos_plant_frame> all_frames(uint32_t on) const {
    std::vector<ipos_plant_frame> all, some;
    while (!(some = opened_.frames(on)).empty()) all.insert(all.end(), some.begin(), some.end());
    return all;
  }
  static ipos_plant_source unrecorded(uint32_t commands_a_ms) {
    ipos_plant_source source{};
    source.commands_a_ms = commands_a_ms;
    source.flags = IPOS_PLANT_NO_RECORD;
    return source;
  }
  uint32_t signal(const char* of, const char* name) const {
    uint32_t found = UINT32_MAX;
    EXPECT_EQ(ipos_plant_find(plant(), station(of), IPOS_PLANT_ANY, name, &found), IPOS_PLANT_OK)
        << opened_.message();
    return found;
  }

  OpenedPlant opened_;
  int64_t sent_ = 0;
  std::vector<HeardFrame> last_;
  std::vector<HeardTelegram> telegrams_;
};

}  // namespace ipos::tests
