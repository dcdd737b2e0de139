// The cycles of a master control.
#include "runtime/bus/movilink/sbus_control.hpp"

#include "runtime/bus/movilink/identifiers.hpp"

namespace ipos::runtime {
namespace {

enum ControlEvent : uint32_t { kSync, kSyncOutput, kOutput };

constexpr uint64_t kSyncTag = 1;
constexpr uint64_t kTargetTags = 2;  // and above: a telegram that still waits is overtaken by the next one

}  // namespace

SbusControl::SbusControl(EventQueue& queue, uint32_t source, ControlSettings settings)
    : queue_(queue), source_(source), settings_(std::move(settings)), answers_(settings_.targets.size()) {}

void SbusControl::start(FrameSender& sender) {
  sender_ = &sender;
  const Time now = queue_.now();
  if (settings_.sync_id) {
    queue_.schedule(now, source_, *this, kSync);
    queue_.schedule(now + kSyncOutputAt, source_, *this, kSyncOutput);
  }
  for (size_t n = 0; n < settings_.targets.size(); ++n)
    if (settings_.targets[n].every > 0) queue_.schedule(now, source_, *this, kOutput, n);
}

void SbusControl::stop() {
  queue_.cancel_all(*this);
  answers_.assign(settings_.targets.size(), {});
}

void SbusControl::on_event(Time now, uint32_t kind, uint64_t argument) {
  switch (kind) {
    case kSync: {
      Frame sync;
      sync.id = *settings_.sync_id;
      sender_->withdraw(kSyncTag);
      sender_->send(sync, kSyncTag);
      queue_.schedule(now + settings_.cycle, source_, *this, kSync);
      break;
    }
    case kSyncOutput:
      for (size_t n = 0; n < settings_.targets.size(); ++n)
        if (settings_.targets[n].every == 0) send_output(n);
      queue_.schedule(now + settings_.cycle, source_, *this, kSyncOutput);
      break;
    default:
      send_output(static_cast<size_t>(argument));
      queue_.schedule(now + settings_.targets[static_cast<size_t>(argument)].every, source_, *this, kOutput, argument);
  }
}

void SbusControl::send_output(size_t number) {
  const ControlTarget& target = settings_.targets[number];
  const Telegram telegram = target.group        ? Telegram::GroupProcessOutput
                            : target.every == 0 ? Telegram::ProcessOutputSync
                                                : Telegram::ProcessOutput;
  sender_->withdraw(kTargetTags + number);
  sender_->send(process_frame(sbus_identifier(telegram, target.address), target.output),
                kTargetTags + number);
  answers_[number].asked += target.group ? 0 : 1;
}

void SbusControl::on_frame(Time now, const Frame& frame) {
  const auto words = process_words(frame);
  if (!words) return;
  for (size_t n = 0; n < settings_.targets.size(); ++n) {
    const ControlTarget& target = settings_.targets[n];
    if (target.group || frame.id != sbus_identifier(Telegram::ProcessInput, target.address)) continue;
    ++answers_[n].answered;
    answers_[n].last = now;
    answers_[n].input = *words;
  }
}

}  // namespace ipos::runtime
