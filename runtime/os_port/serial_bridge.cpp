// Towards the port a telegram goes in one piece, as soon as its first character has been heard: the line
// knows what follows, and a late host must not tear gaps into it. A pseudo-terminal has no wire time of its
// own, so there each character goes when it has ended on the line.
#include "runtime/os_port/serial_bridge.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime {
namespace {

constexpr size_t kMostBytes = 4096;  // bytes from the port; the rest waits in the system (ours)

// How long after its time on the wire a byte may come back as an echo (ours: two 16 ms timers of USB
// adapters).
constexpr Time kEchoDelay = 32 * kMillisecond;

std::vector<bool> bits_of(const ByteArrival& byte) {
  std::vector<bool> bits = wire_bits(std::span(&byte.value, 1));
  constexpr size_t kParityBit = 9;
  if (byte.bad) bits[kParityBit] = !bits[kParityBit];
  return bits;
}

}  // namespace

// --- pace

bool ArrivalPace::continues(Time at) const {
  if (telegram_.size == 0 || at - last_at_ > character_ + kCharacterGap + latency_) return false;
  if (telegram_.size < 3) return true;
  const auto format = telegram_format(telegram_.data[2]);
  return format && telegram_.size < telegram_length(*format);
}

Time ArrivalPace::begin(const ByteArrival& byte) {
  const bool more = continues(byte.at);
  last_at_ = byte.at;
  if (!more) telegram_ = {};
  telegram_.push(byte.value);
  return more ? byte.at : byte.at + latency_;
}

// --- from the port

SerialBridge::SerialBridge(EventQueue& queue, uint32_t source, Rs485Line& line, BytePort& port, Time slack)
    : ByteBridge(port),
      queue_(queue),
      source_(source),
      line_(line),
      node_(line.attach(port.name(), line.baud(), *this)),
      character_(character_time(line.baud())),
      pace_(std::max(port.latency(), slack), character_) {}

std::string SerialBridge::crowded() const {
  return fmt::format("{} bytes wait for the simulated line: they come faster than its {} baud", kMostBytes,
                     line_.baud());
}

bool SerialBridge::has_room() const { return arrivals_.size() < kMostBytes; }

// What has not come back in its time does not come back any more.
void SerialBridge::forget_echo(Time now) {
  while (!echo_.empty() && echo_.front().until < now) {
    echo_.pop_front();
    echoed_in_a_row_ = 0;
  }
}

// An adapter that hears itself gives every byte back. A telegram from outside is not taken for an echo: an
// answer begins with another character than its request.
bool SerialBridge::is_echo(const ByteArrival& byte) {
  forget_echo(byte.at);
  if (echo_.empty()) return false;
  if (echo_.front().value != byte.value || byte.bad) {
    echo_.clear();
    echoed_in_a_row_ = 0;
    return false;
  }
  const size_t ends = echo_.front().ends;
  echo_.pop_front();
  ++echoed_bytes_;
  ++echoed_in_a_row_;
  // Noise may hit on a single byte. A whole telegram is no chance.
  if (ends != 0 && echoed_in_a_row_ >= ends)
    notes().note(fmt::format("{}: the adapter hears itself: its echo is left out", port().name()));
  return true;
}

void SerialBridge::arrive(const ByteArrival& byte) {
  if (is_echo(byte)) return;
  if (byte.bad) ++bad_bytes_;
  if (byte.at < queue_.now()) {
    ++counts().late;
    counts().worst_late = std::max(counts().worst_late, queue_.now() - byte.at);
  }
  arrivals_.push_back({pace_.begin(byte), byte.value, byte.bad});
  if (arrivals_.size() == 1) begin_first();
}

void SerialBridge::begin_first() { queue_.schedule(arrivals_.front().at, source_, *this, 0); }

void SerialBridge::on_event(Time now, uint32_t /*kind*/, uint64_t /*argument*/) {
  if (line_.send_bits(node_, bits_of(arrivals_.front()))) return;  // goes on in on_sent()
  ++counts().undelivered;
  on_sent(now);
}

void SerialBridge::on_sent(Time /*now*/) {
  arrivals_.pop_front();
  if (!arrivals_.empty()) begin_first();
}

// --- to the port

void SerialBridge::on_character(Time now, const Character& character) {
  while (!passed_on_.empty() && passed_on_.front().end < character.end) passed_on_.pop_front();
  if (!passed_on_.empty() && passed_on_.front().end == character.end) {
    if (!(passed_on_.front() == character))
      notes().note(fmt::format("{}: telegrams that collide on the simulated line have gone out in part",
                              port().name()));
    passed_on_.pop_front();
    return;
  }
  if (!port().paces()) return pass_on(now, std::span(&character, 1));
  std::vector<Character> characters{character};
  for (const Character& next : line_.upcoming(node_)) {
    passed_on_.push_back(next);
    characters.push_back(next);
  }
  pass_on(now, characters);
}

// A port cannot send a character with an error. It is left out, so that its telegram is void outside, too.
void SerialBridge::pass_on(Time now, std::span<const Character> characters) {
  std::vector<uint8_t> bytes;
  for (const Character& character : characters) {
    if (character.parity_error || character.framing_error)
      notes().note(
          fmt::format("{}: disturbed characters of the simulated line are not passed on", port().name()));
    else
      bytes.push_back(character.data);
  }
  port().send(bytes);
  if (!port().paces()) return;
  const Time end = now + static_cast<Time>(bytes.size()) * character_ + port().latency() + kEchoDelay;
  forget_echo(now);
  for (const uint8_t byte : bytes) echo_.push_back({byte, end, 0});
  if (!bytes.empty()) echo_.back().ends = bytes.size();
}

}  // namespace ipos::runtime
