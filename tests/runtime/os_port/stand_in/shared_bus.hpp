// A CAN bus in a file that programs map: the stand-ins for makers' libraries join their channels to it, also of several
// programs, of Linux and of Windows under wine. It carries frames to all other channels, and has switches with which a test
// pulls a channel out, fills its queue or sends it bus-off. The file is named by IPOS_STAND_IN_BUS; without it no adapter is
// plugged in.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>

#ifdef _WIN32
#include <windows.h>
#else
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace ipos::tests {

// Of SharedBusFile, a bit for each channel in all of them but `errors`. tests/tools/windows_ports.sh writes them by their
// places.
struct BusSwitches {
  std::atomic<uint32_t> gone;       // pulled out
  std::atomic<uint32_t> full;       // takes no frames now
  std::atomic<uint32_t> off;        // bus-off, until it is restarted
  std::atomic<uint32_t> passive;    // error passive
  std::atomic<uint32_t> warning;    // error warning
  std::atomic<uint32_t> bad_frame;  // refuses frames for another reason
  std::atomic<uint32_t> in_use;     // by another program, which has another rate
  std::atomic<uint32_t> lost;       // frames to it were lost; it says so once
};

struct BusSlot {
  enum Kind : uint32_t { kData, kError };
  std::atomic<uint64_t> number;  // n + 1 for the slot of number n, when it is complete
  uint64_t microseconds;
  uint32_t sender;  // a channel; kTester: the test
  uint32_t baud;
  Kind kind;
  uint32_t id;  // of an error: 1 bit, 2 form, 4 stuff, 8 other, 16 no acknowledge
  uint8_t length, extended, remote, unused;
  uint8_t data[8];
};

struct SharedBusFile {
  BusSwitches switches;
  std::atomic<uint64_t> written;
  static constexpr uint64_t kSlots = 4096;
  BusSlot slots[kSlots];
};

inline constexpr uint32_t kTester = 31;
// Each library has eight channels: those of PCAN-Basic are the bits 0 to 7.
inline constexpr uint32_t kPcanChannels = 0, kVectorChannels = 8, kKvaserChannels = 16, kIxxatChannels = 24;

// nullptr: no bus. It is mapped once a library.
inline SharedBusFile* map_bus(const char* path) {
  if (path == nullptr) return nullptr;
#ifdef _WIN32
  const HANDLE file = CreateFileA(path, GENERIC_READ | GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE, nullptr,
                                  OPEN_ALWAYS, FILE_ATTRIBUTE_NORMAL, nullptr);
  if (file == INVALID_HANDLE_VALUE) return nullptr;
  const HANDLE mapping = CreateFileMappingA(file, nullptr, PAGE_READWRITE, 0, sizeof(SharedBusFile), nullptr);
  if (mapping == nullptr) return nullptr;
  return static_cast<SharedBusFile*>(MapViewOfFile(mapping, FILE_MAP_ALL_ACCESS, 0, 0, sizeof(SharedBusFile)));
#else
  const int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (file < 0 || ftruncate(file, sizeof(SharedBusFile)) != 0) return nullptr;
  void* const at = mmap(nullptr, sizeof(SharedBusFile), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  return at == MAP_FAILED ? nullptr : static_cast<SharedBusFile*>(at);
#endif
}

inline SharedBusFile* the_bus() {
  static SharedBusFile* const bus = map_bus(std::getenv("IPOS_STAND_IN_BUS"));
  return bus;
}

inline void put(SharedBusFile& bus, BusSlot::Kind kind, uint32_t sender, uint32_t baud, uint32_t id, uint8_t length,
                bool extended, bool remote, const void* data, uint64_t microseconds) {
  const uint64_t number = bus.written.fetch_add(1);
  BusSlot& slot = bus.slots[number % SharedBusFile::kSlots];
  slot.number = 0;
  slot.microseconds = microseconds;
  slot.sender = sender;
  slot.baud = baud;
  slot.kind = kind;
  slot.id = id;
  slot.length = length;
  slot.extended = extended;
  slot.remote = remote;
  std::memset(slot.data, 0, sizeof slot.data);
  if (data != nullptr) std::memcpy(slot.data, data, length < 8 ? length : 8);
  slot.number = number + 1;
}

// A channel that a program has opened.
class BusChannel {
 public:
  // `bit`: which of all channels of all libraries.
  BusChannel(SharedBusFile& bus, uint32_t bit) : bus_(bus), bit_(bit), next_(bus.written) {}

  uint32_t baud = 0;

  bool has(const std::atomic<uint32_t>& of_switches) const { return (of_switches >> bit_ & 1U) != 0; }
  BusSwitches& switches() const { return bus_.switches; }
  uint32_t bit() const { return bit_; }
  void clear(std::atomic<uint32_t>& of_switches) const { of_switches &= ~(1U << bit_); }

  void write(uint32_t id, uint8_t length, bool extended, bool remote, const void* data) {
    using namespace std::chrono;
    const auto now = duration_cast<microseconds>(steady_clock::now().time_since_epoch()).count();
    put(bus_, BusSlot::kData, bit_, baud, id, length, extended, remote, data, static_cast<uint64_t>(now));
  }

  // The next one of others; nothing: there is none now. That of another rate is heard as an error of form.
  struct Heard {
    BusSlot::Kind kind;
    uint64_t microseconds;
    uint32_t id;
    uint8_t length;
    bool extended, remote;
    uint8_t data[8];
  };
  std::optional<Heard> read() {
    if (has(switches().off)) return std::nullopt;
    for (; next_ < bus_.written; ++next_) {
      const BusSlot& slot = bus_.slots[next_ % SharedBusFile::kSlots];
      if (slot.number != next_ + 1) return std::nullopt;  // it is being written
      if (slot.sender == bit_) continue;
      Heard heard{slot.kind,        slot.microseconds, slot.id,
                  slot.length,      slot.extended != 0, slot.remote != 0, {}};
      std::memcpy(heard.data, slot.data, sizeof heard.data);
      if (slot.baud != 0 && slot.baud != baud) heard = {BusSlot::kError, slot.microseconds, 2, 0, false, false, {}};
      ++next_;
      return heard;
    }
    return std::nullopt;
  }

 private:
  SharedBusFile& bus_;
  uint32_t bit_;
  uint64_t next_;
};

}  // namespace ipos::tests

#ifdef _WIN32
#define IPOS_EXPORTED extern "C" __declspec(dllexport)
#else
#define IPOS_EXPORTED extern "C" __attribute__((visibility("default")))
#endif
