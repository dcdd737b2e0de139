// Each byte chooses a function, the next ones its arguments.
#include "tests/runtime/library/calls.hpp"


#include <algorithm>
#include <array>
#include <cstdlib>
#include <new>
#include <vector>

#include "tests/runtime/library/functions.hpp"

namespace {

thread_local int64_t allocations_left = -1;
thread_local int64_t live = 0;

void* allocate_or_null(size_t size) noexcept {
  if (allocations_left == 0) return nullptr;
  if (allocations_left > 0) --allocations_left;
  void* const memory = std::malloc(size == 0 ? 1 : size);
  if (memory != nullptr) ++live;
  return memory;
}
void* allocate(size_t size) {
  void* const memory = allocate_or_null(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void release(void* memory) {
  if (memory != nullptr) --live;
  std::free(memory);
}

}  // namespace

void* operator new(size_t size) { return allocate(size); }
void* operator new[](size_t size) { return allocate(size); }
void* operator new(size_t size, const std::nothrow_t&) noexcept { return allocate_or_null(size); }
void* operator new[](size_t size, const std::nothrow_t&) noexcept { return allocate_or_null(size); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, size_t) noexcept { release(memory); }
void operator delete[](void* memory, size_t) noexcept { release(memory); }

namespace ipos::tests {

void fail_allocations_after(int64_t count) { allocations_left = count; }
int64_t live_allocations() { return live; }

namespace {

constexpr const char* kPlant = R"([[bus]]
name = "sbus"
kind = "can"
[[bus]]
name = "rs"
kind = "rs485"
baud = 9600
[[station]]
name = "a"
unit = "mdxb"
sbus = "sbus"
rs485 = "rs"
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
[[station]]
name = "b"
unit = "mc07"
sbus = "sbus"
[station.parameters]
P813 = 1
)";
constexpr const char* kTexts[] = {"a",
                                  "b",
                                  "sbus",
                                  "rs",
                                  "P130",
                                  "DI03",
                                  "DO01",
                                  "AI1",
                                  "speed",
                                  "PO1",
                                  "PI2",
                                  "H5",
                                  "torque",
                                  "2.5 s",
                                  "5 V",
                                  "12 mA",
                                  "1",
                                  "0x10",
                                  "",
                                  "-5",
                                  "nothing",
                                  "\xff\xfe",
                                  "[[fault]]\nbus = \"sbus\"\nkind = \"stuck\"\nuntil = \"2ms\"\n",
                                  "[[fault]]\n",
                                  "P813",
                                  "potentiometer",
                                  "50 %",
                                  "load_torque",
                                  "-2.5 Nm",
                                  "task1.line"};
constexpr int64_t kLongestRun = 20'000'000;  // ns
constexpr size_t kMostSaves = 2;

class Player {
 public:
  explicit Player(std::span<const uint8_t> bytes) : left_(bytes) {}
  ~Player() { ipos_plant_close(plant_); }
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  Outcome play() {
    if (const uint8_t failing = u8(); failing != 0) fail_allocations_after(int64_t{failing} * failing * 4);
    ipos_plant_source source = {};
    source.text = kPlant;
    source.flags = u8() % 8 == 0 ? uint32_t{IPOS_PLANT_NO_RECORD} : 0U;
    const ipos_plant_status opened = ipos_plant_open(&source, &plant_);
    require(opened == IPOS_PLANT_OK || opened == IPOS_PLANT_OUT_OF_MEMORY, "a good plant opens");
    require((opened == IPOS_PLANT_OK) == (plant_ != nullptr), "without memory there is no plant");
    while (!left_.empty() && plant_ != nullptr) {
      const ipos_plant_status status = call();
      ++outcome_.calls;
      require(*ipos_plant_status_text(status) != 0, "every status is one of the table");
      if (broken_) require(status == IPOS_PLANT_BROKEN || stays(status), "a broken plant stays broken");
      broken_ = broken_ || status == IPOS_PLANT_OUT_OF_MEMORY || status == IPOS_PLANT_BROKEN;
      if (status == IPOS_PLANT_BROKEN) require(broken_, "only want of memory breaks a plant");
    }
    fail_allocations_after(-1);
    return outcome_;
  }

 private:
  // Answers that come before the plant is looked at.
  static bool stays(ipos_plant_status status) {
    return status == IPOS_PLANT_INVALID_ARGUMENT || status == IPOS_PLANT_OK || status == IPOS_PLANT_NOTHING ||
           status == IPOS_PLANT_BAD_VALUE;
  }
  void require(bool kept, const char* promise) {
    if (!kept && outcome_.broken == nullptr) outcome_.broken = promise;
  }
  uint8_t u8() {
    if (left_.empty()) return 0;
    const uint8_t byte = left_.front();
    left_ = left_.subspan(1);
    return byte;
  }
  uint32_t small() { return u8() % 5 == 0 ? UINT32_MAX : u8() % 4; }
  const char* text() { return kTexts[u8() % std::size(kTexts)]; }
  int64_t value() {
    const uint8_t kind = u8();
    if (kind < 200) return kind - 100;
    return kind < 220 ? INT64_MIN : kind < 240 ? INT64_MAX : int64_t{UINT32_MAX} + 1;
  }

  ipos_plant_status call() {
    int64_t now = 0;
    switch (u8() % 36) {
      case 0: ipos_plant_time(plant_, &now); return ipos_plant_run(plant_, now + u8() * int64_t{100'000});
      case 1: return ipos_plant_run(plant_, value());
      case 2:
        ipos_plant_time(plant_, &now);
        return ipos_plant_run_until(plant_, now + kLongestRun / 4, condition, this);
      case 3: return ipos_plant_run_until(plant_, 0, nullptr, nullptr);
      case 4:
        ipos_plant_time(plant_, &now);
        return ipos_plant_run_to_frame(plant_, small(), now + kLongestRun);
      case 5: return ipos_plant_station(plant_, text(), &number_);
      case 6: return ipos_plant_station_at(plant_, small(), &station_);
      case 7: return ipos_plant_power(plant_, small(), u8() % 2 == 0);
      case 8: return ipos_plant_program(plant_, small(), static_cast<int32_t>(u8() % 5) - 1);
      case 9: return ipos_plant_drive_fault(plant_, small(), u8());
      case 10: return ipos_plant_reset_fault(plant_, small());
      case 11: return ipos_plant_why(plant_, small(), &words_);
      case 12:
      case 13:
      case 14: return ipos_plant_find(plant_, small(), static_cast<int32_t>(u8() % 11) - 1, text(), &number_);
      case 15: return ipos_plant_signal_info_of(plant_, u8() % 12U, &signal_);
      case 16:
        return ipos_plant_name_at(plant_, small(), static_cast<int32_t>(u8() % 11) - 1,
                                  u8() % 2 == 0 ? nullptr : text(), u8(), &words_);
      case 17: return ipos_plant_read(plant_, u8() % 12U, &now);
      case 18: {
        std::array<uint32_t, 4> signals{};
        std::array<int64_t, 4> values{};
        for (uint32_t& each : signals) each = u8() % 8U;
        return ipos_plant_read_many(plant_, signals.data(), u8() % 5U, values.data());
      }
      case 19: return ipos_plant_read_text(plant_, u8() % 12U, &words_);
      case 20: return ipos_plant_write(plant_, u8() % 12U, value());
      case 21: return ipos_plant_write_text(plant_, u8() % 12U, text());
      case 22: return ipos_plant_force(plant_, u8() % 12U, value());
      case 23: return ipos_plant_force_text(plant_, u8() % 12U, text());
      case 24: return ipos_plant_release(plant_, u8() % 12U);
      case 25: return ipos_plant_bus(plant_, text(), &number_);
      case 26: return ipos_plant_bus_load(plant_, small(), &load_);
      case 27: {
        ipos_plant_frame frame = {};
        frame.id = u8() * 16U;
        frame.length = u8() % 10;
        frame.flags = u8() % 6U;
        return ipos_plant_send(plant_, small(), &frame, &number_);
      }
      case 28: {
        std::array<ipos_plant_frame, 3> frames{};
        size_t count = 0;
        return ipos_plant_receive(plant_, small(), frames.data(), frames.size(), &count);
      }
      case 29: {
        const std::array<uint8_t, 6> bytes = {2, 1, 5, u8(), u8(), u8()};
        ipos_plant_serial_receive(plant_, small(), &telegram_);
        return ipos_plant_serial_send(plant_, small(), bytes.data(), u8() % 7U);
      }
      case 30:
        if (u8() % 2 == 0) return ipos_plant_line_fault(plant_, text());
        return ipos_plant_fms(plant_, small(), u8() % 12, u8() % 9, "read", static_cast<uint16_t>(900 + u8()), nullptr, 0, 0, &fms_);
      case 31: return ipos_plant_journal_at(plant_, u8() % 8U, &entry_);
      case 32: return save();
      case 33: return saves_++ >= kMostSaves ? IPOS_PLANT_OK : ipos_plant_replay(plant_, condition, this);
      case 34: return ipos_plant_restart(plant_);
      default: return restore();
    }
  }

  // Within it only reading is allowed.
  static bool condition(void* user, ipos_plant* plant) {
    auto* self = static_cast<Player*>(user);
    int64_t now = 0;
    const ipos_plant_status run = ipos_plant_run(plant, 0);
    self->require(run == IPOS_PLANT_BUSY, "a callback cannot run the plant");
    self->require(ipos_plant_close(plant) == IPOS_PLANT_BUSY, "a callback cannot close the plant");
    ipos_plant_read(plant, 0, &now);
    return self->u8() % 3 == 0;
  }

  ipos_plant_status save() {
    if (saves_++ >= kMostSaves) return IPOS_PLANT_OK;
    uint64_t hash = 0;
    if (u8() % 4 == 0) return ipos_plant_trace_hash(plant_, &hash);
    size_t size = 0;
    const ipos_plant_status status = ipos_plant_save(plant_, nullptr, &size);
    if (status != IPOS_PLANT_TOO_SMALL) return status;
    const int64_t left = allocations_left;
    allocations_left = -1;  // this one is the test's
    saved_.resize(size);
    allocations_left = left;
    return ipos_plant_save(plant_, saved_.data(), &size);
  }

  ipos_plant_status restore() {
    if (saved_.empty() || saves_++ >= 2 * kMostSaves) return IPOS_PLANT_OK;
    if (const uint8_t change = u8(); change % 3 == 0) saved_[(change * 7U) % saved_.size()] ^= u8();
    return ipos_plant_restore(plant_, saved_.data(), saved_.size());
  }

  std::span<const uint8_t> left_;
  Outcome outcome_;
  ipos_plant* plant_ = nullptr;
  bool broken_ = false;
  size_t saves_ = 0;
  std::vector<uint8_t> saved_;
  uint32_t number_ = 0;
  const char* words_ = nullptr;
  ipos_plant_station_info station_{};
  ipos_plant_signal_info signal_{};
  ipos_plant_load load_{};
  ipos_plant_telegram telegram_{};
  ipos_plant_fms_answer fms_{};
  ipos_plant_entry entry_{};
};

}  // namespace

Outcome play_calls(std::span<const uint8_t> bytes) {
  fail_allocations_after(-1);
  Outcome outcome;
  {
    Player player(bytes);
    outcome = player.play();
  }
  return outcome;
}

}  // namespace ipos::tests
