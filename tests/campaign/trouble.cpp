// The plants are those of tests/runtime/plant; here comes what they have to bear.
#include "tests/campaign/trouble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "tests/campaign/promises.hpp"
#include "tests/runtime/plant/busy_plant.hpp"
#include "tests/runtime/plant/waiting_plant.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;
using runtime::Time;

constexpr int kLongest = 2'500;  // ms of a run

class Dice {
 public:
  explicit Dice(uint64_t seed) : random_(seed * 2 + 1) {}
  int pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool one_in(int n) { return pick(1, n) == 1; }

 private:
  std::mt19937_64 random_;
};

size_t count(const std::string& text, std::string_view word) {
  size_t found = 0;
  for (size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += word.size()) ++found;
  return found;
}

std::string fault(Dice& dice) {
  const int from = dice.pick(0, kLongest - 200);
  const std::string until = fmt::format("from = \"{}us\"\nuntil = \"{}us\"\n",
                                        from * 1000 + dice.pick(0, 999), (from + dice.pick(1, 800)) * 1000);
  static constexpr const char* kOfFrames[] = {"drop", "corrupt", "duplicate", "terminator"};
  static constexpr const char* kOfWires[] = {"short", "stuck"};
  switch (dice.pick(0, 3)) {
    case 0:
      return fmt::format("[[fault]]\nbus = \"can\"\nkind = \"{}\"\nrate = {}\nseed = {}\n{}",
                         kOfFrames[dice.pick(0, 3)], dice.pick(1, 400), dice.pick(1, 999), until);
    case 1:
      return fmt::format(
          "[[fault]]\nbus = \"can\"\nkind = \"delay\"\ndelay = \"{}us\"\nrate = {}\nseed = {}\n{}",
          dice.pick(1, 20'000), dice.pick(1, 400), dice.pick(1, 999), until);
    case 2:
      return fmt::format("[[fault]]\nbus = \"can\"\nkind = \"{}\"\nstation = \"u0\"\n{}",
                         dice.one_in(2) ? "cut" : "swap", until);
    default:
      return fmt::format("[[fault]]\nbus = \"can\"\nkind = \"{}\"\n{}", kOfWires[dice.pick(0, 1)], until);
  }
}

// A frame that nobody should send: identifiers of units and objects, wrong lengths, remote frames, noise.
std::string hostile_frame(Dice& dice) {
  int id = dice.one_in(2)   ? dice.pick(0, 0x7FF)
           : dice.one_in(2) ? 8 * dice.pick(0, 9) + dice.pick(0, 7)
                            : 1100 + dice.pick(0, 6);
  if (id == kPairObject) ++id;
  if (dice.one_in(12)) return fmt::format("{:03X}#R", id);
  std::string text = fmt::format("{:03X}#", id);
  for (int n = dice.pick(0, 8); n > 0; --n) text += fmt::format("{:02X}", dice.pick(0, 255));
  return text;
}

// A request, whole or broken, with a right or a wrong check.
std::string hostile_bytes(Dice& dice) {
  std::string text = dice.one_in(4) ? "" : fmt::format("02 {:02X} 85", dice.pick(0, 9));
  for (int n = dice.pick(1, 9); n > 0; --n) text += fmt::format(" {:02X}", dice.pick(0, 255));
  if (!dice.one_in(4)) text += " bcc";
  return text.starts_with(' ') ? text.substr(1) : text;
}

// A frame on PROFIBUS: a right one to anybody (a request for data, Set_Prm, Chk_Cfg, Get_Cfg, a token), one with turned or
// missing octets, or noise.
std::string hostile_octets(Dice& dice) {
  static constexpr int kServices[] = {0, 54, 55, 56, 57, 58, 59, 60, 61, 62};  // access points of a DP slave
  const auto octet = [&] { return fmt::format(" {:02X}", dice.pick(0, 255)); };
  std::string data;
  for (int n = dice.pick(0, 12); n > 0; --n) data += octet();
  const int to = dice.one_in(3) ? dice.pick(0, 127) : dice.pick(8, 9), from = dice.pick(0, 10);
  const int function = dice.one_in(2) ? 0x5D : dice.pick(0, 255);
  switch (dice.pick(0, 4)) {
    case 0: return fmt::format("DC {:02X} {:02X}", to, from);
    case 1: return fmt::format("10 {:02X} {:02X} {:02X} fcs 16", to, from, function);
    case 2: {  // with access points
      const std::string units = fmt::format(" {:02X} {:02X} {:02X} {:02X} {:02X}{}", to | 128, from | 128,
                                            function, kServices[dice.pick(0, 9)], 62, data);
      const int length = static_cast<int>(units.size()) / 3;
      return fmt::format("68 {0:02X} {0:02X} 68{1} fcs 16", length, units);
    }
    case 3: return fmt::format("68 {0:02X} {0:02X} 68{1} fcs 16", dice.pick(0, 255), data + octet());
    default: return (data + octet()).substr(1);
  }
}

// The kinds of the buses, in the order of the plant file.
enum class Line { Can, Serial, Profibus };

std::string hostile_message(Dice& dice, Line line) {
  switch (line) {
    case Line::Can: return hostile_frame(dice);
    case Line::Serial: return hostile_bytes(dice);
    case Line::Profibus: return hostile_octets(dice);
  }
  return {};
}

Action action(Dice& dice, size_t stations, int lines) {
  Action action;
  action.at = Time{dice.pick(0, kLongest * 1000)} * runtime::kMicrosecond;
  action.target = static_cast<size_t>(dice.pick(0, static_cast<int>(stations) - 1));
  switch (dice.pick(0, 7)) {
    case 0:
    case 1:
      action.kind = dice.one_in(2) ? Action::Kind::PowerOff : Action::Kind::PowerOn;
      action.target = static_cast<size_t>(dice.pick(0, static_cast<int>(stations) + kPairStations - 1));
      break;
    case 2:
    case 3: {
      action.kind = Action::Kind::Send;
      const int line = dice.one_in(3) ? dice.pick(1, lines - 1) : 0;
      action.target = static_cast<size_t>(line);
      action.message = hostile_message(dice, static_cast<Line>(line));
      break;
    }
    case 4:
      action.kind = Action::Kind::Force;
      action.index = static_cast<uint16_t>(dice.pick(0, 5));
      action.value = dice.pick(0, 1);
      break;
    case 5:
      action.kind = dice.one_in(2) ? Action::Kind::Write : Action::Kind::Store;
      action.index = static_cast<uint16_t>(dice.one_in(3)   ? 8'300 + dice.pick(0, 700)
                                         : dice.one_in(2) ? 11'000 + dice.pick(0, 127)  // can be kept
                                                          : 11'000 + dice.pick(0, 560));
      action.value = dice.one_in(2) ? dice.pick(-3, 200) : dice.pick(INT32_MIN, INT32_MAX);
      break;
    default: break;  // who looks, or lets time stand still a while
  }
  return action;
}

// The first bus of each plant is its CAN.
std::string_view baud_of_can(std::string_view plant) {
  static constexpr std::string_view kKey = "baud = ";
  const size_t at = plant.find(kKey) + kKey.size();
  return plant.substr(at, plant.find('\n', at) - at);
}

const char* word(Action::Kind kind) {
  switch (kind) {
    case Action::Kind::PowerOff: return "power off";
    case Action::Kind::PowerOn: return "power on";
    case Action::Kind::Send: return "send";
    case Action::Kind::Force: return "force";
    case Action::Kind::Write: return "write";
    case Action::Kind::Store: return "store";
    case Action::Kind::Look: return "look";
  }
  return "";
}

}  // namespace

std::string Trouble::text(const std::string& folder) const {
  static constexpr std::string_view kTable = "[[station]]\nname = \"u";  // a drive; a gateway has no memory
  std::string text = plant;
  if (files) {
    int station = 0;
    for (size_t at = 0; (at = text.find(kTable, at)) != std::string::npos; ++station)
      text.insert(at += kTable.find('\n') + 1, fmt::format("nvram = \"{}/{}.nv\"\n", folder, station));
  }
  for (const std::string& one : faults) text += one;
  return text;
}

Trouble draw_trouble(uint64_t seed) {
  Dice dice(seed);
  Trouble trouble;
  trouble.seed = seed;
  if (dice.one_in(2)) {
    const BusyPlant plant(seed);
    trouble.plant = plant.text();
    trouble.programs = plant.sources();
  } else {
    const WaitingPlant plant(seed);
    trouble.plant = plant.text();
    trouble.programs = plant.sources();
  }
  const size_t stations = count(trouble.plant, "[[station]]") - count(trouble.plant, "unit = \"gateway\"");
  const int lines = static_cast<int>(count(trouble.plant, "[[bus]]"));
  Pair pair = make_pair_at(baud_of_can(trouble.plant));
  trouble.plant += pair.stations;
  trouble.programs.merge(pair.programs);
  for (int n = dice.pick(0, 4); n > 0; --n) trouble.faults.push_back(fault(dice));
  for (int n = dice.pick(4, 40); n > 0; --n) trouble.actions.push_back(action(dice, stations, lines));
  // A storm: many messages in a row.
  if (dice.one_in(4)) {
    Action storm;
    storm.kind = Action::Kind::Send;
    const Time at = Time{dice.pick(0, kLongest - 100)} * kMillisecond;
    for (int n = dice.pick(20, 200); n > 0; --n) {
      storm.at = at + Time{n * dice.pick(50, 400)} * runtime::kMicrosecond;
      storm.message = hostile_frame(dice);
      trouble.actions.push_back(storm);
    }
  }
  trouble.end = Time{kLongest} * kMillisecond;
  trouble.files = dice.one_in(3);
  std::ranges::stable_sort(trouble.actions, {}, &Action::at);
  return trouble;
}

std::string describe(const Trouble& trouble) {
  std::string out = fmt::format("seed {}\n{}", trouble.seed, trouble.text("."));
  for (const auto& [name, source] : trouble.programs) out += fmt::format("--- {}\n{}", name, source);
  for (const Action& one : trouble.actions)
    out += fmt::format("{} ns: {} {} index {} value {} '{}'\n", one.at, word(one.kind), one.target, one.index,
                       one.value, one.message);
  return out + fmt::format("until {} ns\n", trouble.end);
}

}  // namespace ipos::tests
