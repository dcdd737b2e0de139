// EMCY messages: 00 FF reg 00 SW1low SW1high 00 00 for a fault (page 53 of 11264926), code 0 when it is gone.
#include "runtime/bus/canopen/emergency.hpp"

namespace ipos::runtime::canopen {
namespace {

constexpr size_t kMostWaiting = 16;  // the oldest ones go (ours)
constexpr uint8_t kMostErrors = 5;   // entries of 1003h

}  // namespace

Emergency::Emergency(const Place& place, ObjectDictionary& dictionary, const State& state)
    : place_(place), dictionary_(dictionary), state_(state), inhibit_(place, *this, 0) {}

uint8_t Emergency::error_register() const {
  unsigned bits = 0;
  for (size_t n = 0; n < present_.size(); ++n)
    if (present_[n]) bits |= kEmergencies[n].error_register;
  return static_cast<uint8_t>(bits);
}

void Emergency::set(Time now, Cause cause, bool present, uint16_t status_word_1) {
  const auto n = static_cast<size_t>(cause);
  if (present_[n] == present) return;
  present_[n] = present;
  const EmergencyRow& row = kEmergencies[n];
  const uint16_t code = present ? row.code : 0;
  const uint16_t status = row.status ? status_word_1 : 0;
  dictionary_.set({objects::kErrorRegister, 0}, error_register());
  if (present) record(code, status);
  if (waiting_.size() == kMostWaiting) waiting_.pop_front();
  waiting_.push_back({static_cast<uint8_t>(code), static_cast<uint8_t>(code >> 8), error_register(), 0,
                      static_cast<uint8_t>(status), static_cast<uint8_t>(status >> 8)});
  may_send(now);
}

// The newest stands first; the upper half is status word 1 (ours).
void Emergency::record(uint16_t code, uint16_t status_word_1) {
  const auto count = static_cast<uint8_t>(dictionary_.value(objects::kErrorField));
  for (uint8_t n = kMostErrors; n > 1; --n)
    dictionary_.set({objects::kErrorField, n},
                    dictionary_.value(objects::kErrorField, static_cast<uint8_t>(n - 1)));
  dictionary_.set({objects::kErrorField, 1}, uint32_t{status_word_1} << 16 | code);
  if (count < kMostErrors) dictionary_.set({objects::kErrorField, 0}, count + 1U);
}

void Emergency::may_send(Time now) {
  const uint32_t cob_id = dictionary_.value(objects::kEmergencyId);
  if ((cob_id & objects::kOff) != 0) return waiting_.clear();
  while (!waiting_.empty() && has_emergency(state_) && !inhibit_.runs()) {
    place_.sender.send({cob_id & objects::kIdMask, 8, waiting_.front()}, place_.tag);
    waiting_.pop_front();
    if (const Time pause = Time{dictionary_.value(objects::kEmergencyInhibit)} * kInhibitUnit; pause > 0)
      inhibit_.start(now + pause);
  }
}

void Emergency::reset() {
  waiting_.clear();
  inhibit_.stop();
  dictionary_.set({objects::kErrorRegister, 0}, error_register());
}

}  // namespace ipos::runtime::canopen
