// Bytes choose an instance, a call and what it is given.
#include "tests/fmi/random_calls.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/fmi/functions.hpp"

namespace ipos::tests {
namespace {

constexpr double kLongestStep = 0.02;
constexpr size_t kMostCalls = 400;

class Player {
 public:
  explicit Player(std::span<const uint8_t> bytes) : left_(bytes) {}
  ~Player() {
    for (size_t n = 0; n < instances_.size(); ++n) drop(n);
  }

  const char* play() {
    for (size_t n = 0; n < kMostCalls && !left_.empty() && broken_ == nullptr; ++n) call();
    return broken_;
  }

 private:
  // Of a CAN line alone.
  static const Resources& line() {
    static const Resources made("[[bus]]\nname = \"b\"\nkind = \"can\"\n[[station]]\nname = \"u\"\nunit = \"mdxb\"\nsbus = \"b\"\n"
                                "[[fault]]\nbus = \"b\"\nkind = \"corrupt\"\nrate = 100\n",
                                "", {{}, {}, fmi::LineChoice{"b", 3}});
    return made;
  }
  static const Resources& resources() {
    static const Resources made(turning_with_program(), "long n; main() { while (1) { n = n + 1; } }\n");
    return made;
  }

  uint8_t byte() {
    if (left_.empty()) return 0;
    const uint8_t value = left_.front();
    left_ = left_.subspan(1);
    return value;
  }
  unsigned reference() {
    const unsigned number = byte() | unsigned{byte()} << 8U;
    return byte() % 16 == 0 ? number * 65'537 : number % (static_cast<unsigned>(resources().variables().all.size()) + 2);
  }
  double real() {
    constexpr std::array<double, 12> kValues = {0, 1, -1, 0.001, 0.01, 5, 1e9, -1e9, 1e300, NAN, INFINITY, 1500};
    return kValues[byte() % kValues.size()];
  }
  void expect(int status, bool may_be_silent = false) {
    if (status != kOk && status != kDiscard && status != kError) broken_ = "a status that is none";
    if (status != kOk && told_.text.empty() && !may_be_silent) broken_ = "an error without a text";
    told_.text.clear();
  }
  void drop(size_t n) {
    if (states_[n] != nullptr) (n == 0 ? fmi2FreeFMUstate : fmi3FreeFMUState)(instances_[n], &states_[n]);
    n == 0 ? fmi2FreeInstance(instances_[n]) : fmi3FreeInstance(instances_[n]);
    instances_[n] = states_[n] = nullptr;
    time_[n] = 0;
  }

  void call() {
    const size_t n = byte() % kInstances;
    void*& c = instances_[n];
    if (c == nullptr) {
      c = n == 0 ? resources().make2(told_) : n == 1 ? resources().make3(told_, byte() % 2 == 0, byte() % 2 == 0) : line().make3(told_, true);
      if (c == nullptr) broken_ = "no instance was made";
    }
    void* used = byte() % 64 == 0 ? nullptr : c;
    n == 0 ? call2(used) : n == 1 ? call3(used) : call_line(used);
  }

  // An operation as the table has it, or nearly, or anything.
  std::string operation() {
    constexpr std::array<uint8_t, 10> kCodes = {0x10, 0x10, 0x10, 0x20, 0x30, 0x31, 0x40, 0x41, 0x42, 0x01};
    std::string out(byte() % 8 == 0 ? byte() % 32 : 8, 0);
    const uint8_t code = kCodes[byte() % kCodes.size()];
    if (out.empty()) return out;
    out[0] = static_cast<char>(code);
    if (out.size() != 8) return out;
    if (code == 0x10) {
      const uint8_t length = byte() % 10;
      out += std::string({static_cast<char>(byte()), static_cast<char>(byte() % 9), 0, 0, static_cast<char>(byte() % 8 == 0), static_cast<char>(byte() % 8 == 0),
                          static_cast<char>(length), 0});
      for (uint8_t n = 0; n < length; ++n) out += static_cast<char>(byte());
    } else if (code == 0x40) {
      const uint8_t kind = byte() % 6;
      out += static_cast<char>(kind);
      if (kind == 4) out += static_cast<char>(byte() % 4);
      else
        for (int n = 0; n < 4; ++n) out += static_cast<char>(n < 3 ? byte() : 0);
    } else if (code == 0x41) {
      out += static_cast<char>(byte() % 5);
    }
    out[4] = static_cast<char>(out.size());
    return out;
  }

  void call_line(void* c) {
    const auto first = static_cast<uint32_t>(line().variables().all.size() + 1);
    const uint32_t vr = byte() % 16 == 0 ? byte() : first + byte() % 16;
    const uint32_t terminal = first + byte() % 3 * 5, data = terminal, rx = terminal + 2, out = terminal + 1, tx = terminal + 3;
    const bool none = c == nullptr, active = true;
    double value = 0, reached = 0;
    int known = 0;
    uint64_t counters[2] = {};
    bool flags[5] = {};
    size_t size = 0;
    switch (byte() % 18) {
      case 0: return expect(fmi3EnterInitializationMode(c, false, 0, 0, false, 0), none);
      case 1: return expect(fmi3ExitInitializationMode(c), none);
      case 2: return expect(fmi3EnterEventMode(c), none);
      case 3: return expect(fmi3EnterStepMode(c), none);
      case 4: return expect(fmi3UpdateDiscreteStates(c, &flags[0], &flags[1], &flags[2], &flags[3], &flags[4], &value), none);
      case 5: return expect(fmi3GetIntervalDecimal(c, &vr, 1, &value, byte() % 16 == 0 ? nullptr : &known), none);
      case 6: return expect(fmi3GetIntervalFraction(c, &tx, 1, &counters[0], &counters[1], &known), none);
      case 7: return expect(fmi3GetBoolean(c, &vr, 1, flags, 1), none);
      case 8: return expect(fmi3SetBoolean(c, &vr, 1, flags, 1), none);
      case 9: return expect(fmi3GetFMUState(c, &states_[2]), none);
      case 10: {
        const int status = fmi3SetFMUState(c, states_[2]);
        const uint32_t time = 0;
        if (status == kOk && fmi3GetFloat64(c, &time, 1, &time_[2], 1) != kOk) time_[2] = 0;
        return expect(status, none);
      }
      case 11: time_[2] = 0; return expect(fmi3Reset(c), none);
      case 12: return byte() % 4 == 0 ? drop(2) : expect(fmi3SetClock(c, &tx, 1, &active), none);
      case 13: {
        const uint8_t* bytes = nullptr;
        return expect(fmi3GetBinary(c, &out, 1, &size, &bytes, 1), none);
      }
      case 14:
      case 15: {
        std::string given = operation();
        while (byte() % 3 == 0) given += operation();
        size = given.size();
        const auto* bytes = reinterpret_cast<const uint8_t*>(given.data());
        expect(fmi3SetClock(c, &rx, 1, &active), none);
        return expect(fmi3SetBinary(c, &data, 1, &size, byte() % 32 == 0 ? nullptr : &bytes, 1), none);
      }
      default: {
        const int status = fmi3DoStep(c, time_[2], kLongestStep * byte() / 255, true, &flags[0], &flags[1], &flags[2], &reached);
        if (status == kOk) time_[2] = reached;
        return expect(status, none);
      }
    }
  }

  void step2(void* c) {
    const double length = byte() % 8 == 0 ? real() : kLongestStep * byte() / 255;
    const int status = fmi2DoStep(c, byte() % 16 == 0 ? real() : time_[0], std::min(length, kLongestStep), 0);
    if (status == kOk) fmi2GetRealStatus(c, 2, &time_[0]);
    expect(status, c == nullptr);
  }

  void call2(void* c) {
    const unsigned vr = reference();
    const bool is_null = byte() % 32 == 0, none = c == nullptr;
    double value = real();
    int whole = byte();
    const char* text = nullptr;
    size_t size = 0;
    switch (byte() % 22) {
      case 0: return expect(fmi2SetupExperiment(c, 0, 0, 0, 0, 0), none);
      case 1: return expect(fmi2EnterInitializationMode(c), none);
      case 2: return expect(fmi2ExitInitializationMode(c), none);
      case 3: return expect(fmi2GetReal(c, is_null ? nullptr : &vr, 1, &value), none);
      case 4: return expect(fmi2SetReal(c, &vr, 1, is_null ? nullptr : &value), none);
      case 5: return expect(fmi2GetInteger(c, &vr, 1, is_null ? nullptr : &whole), none);
      case 6: return expect(fmi2SetInteger(c, &vr, 1, &whole), none);
      case 7: return expect(fmi2GetBoolean(c, &vr, 1, &whole), none);
      case 8: return expect(fmi2SetBoolean(c, &vr, 1, &whole), none);
      case 9: return expect(fmi2GetString(c, &vr, 1, &text), none);
      case 10: return expect(fmi2GetFMUstate(c, is_null ? nullptr : &states_[0]), none);
      case 11: {
        const int status = fmi2SetFMUstate(c, states_[0]);
        if (status == kOk && fmi2GetRealStatus(c, 2, &time_[0]) != kOk) time_[0] = 0;
        return expect(status, none);
      }
      case 12: return expect(fmi2SerializedFMUstateSize(c, states_[0], &size), none);
      case 13: return keep(c);
      case 14: return expect(fmi2Terminate(c), none);
      case 15: time_[0] = 0; return expect(fmi2Reset(c), none);
      case 16: return expect(fmi2CancelStep(c), none);
      case 17: return expect(fmi2SetDebugLogging(c, 1, 0, nullptr), none);
      case 18: return expect(fmi2GetRealOutputDerivatives(c, &vr, 1, nullptr, nullptr), none);
      case 19: return drop(0);
      default: return step2(c);
    }
  }

  // As bytes, perhaps damaged, and back.
  void keep(void* c) {
    size_t size = 0;
    if (states_[0] == nullptr || fmi2SerializedFMUstateSize(c, states_[0], &size) != kOk) return expect(kOk);
    std::vector<char> bytes(size);
    expect(fmi2SerializeFMUstate(c, states_[0], bytes.data(), size));
    if (byte() % 2 == 0) bytes[byte() % size] = static_cast<char>(byte());
    void* read = nullptr;
    expect(fmi2DeSerializeFMUstate(c, bytes.data(), size, &read));
    if (read != nullptr) expect(fmi2FreeFMUstate(c, &read));
  }

  void call3(void* c) {
    const unsigned vr = reference();
    const bool none = c == nullptr;
    double value = real(), reached = 0;
    int64_t wide = byte();
    bool flags[5] = {};
    switch (byte() % 18) {
      case 0: return expect(fmi3EnterInitializationMode(c, false, 0, 0, false, 0), none);
      case 1: return expect(fmi3ExitInitializationMode(c), none);
      case 2: return expect(fmi3EnterEventMode(c), none);
      case 3: return expect(fmi3EnterStepMode(c), none);
      case 4: return expect(fmi3UpdateDiscreteStates(c, &flags[0], &flags[1], &flags[2], &flags[3], &flags[4], &value), none);
      case 5: return expect(fmi3GetFloat64(c, &vr, 1, &value, byte() % 4 == 0 ? 2 : 1), none);
      case 6: return expect(fmi3SetFloat64(c, &vr, 1, &value, 1), none);
      case 7: return expect(fmi3GetInt64(c, &vr, 1, &wide, 1), none);
      case 8: return expect(fmi3SetInt64(c, &vr, 1, &wide, 1), none);
      case 9: return expect(fmi3SetBoolean(c, &vr, 1, flags, 1), none);
      case 10: return expect(fmi3GetFMUState(c, &states_[1]), none);
      case 11: return expect(fmi3SetFMUState(c, states_[1]), none);
      case 12: return expect(fmi3Terminate(c), none);
      case 13: time_[1] = 0; return expect(fmi3Reset(c), none);
      case 14: return drop(1);
      case 15: return expect(fmi3GetClock(c, &vr, 1, flags), none);
      default: {
        const int status = fmi3DoStep(c, time_[1], kLongestStep * byte() / 255, true, &flags[0], &flags[1], &flags[2], &reached);
        if (status == kOk) time_[1] = reached;
        return expect(status, none);
      }
    }
  }

  std::span<const uint8_t> left_;
  Told told_;
  static constexpr size_t kInstances = 3;  // of FMI 2.0, of FMI 3.0, and a line alone
  std::array<void*, kInstances> instances_{}, states_{};
  std::array<double, kInstances> time_{};
  const char* broken_ = nullptr;
};

}  // namespace

const char* play_fmi_calls(std::span<const uint8_t> bytes) { return Player(bytes).play(); }

}  // namespace ipos::tests
