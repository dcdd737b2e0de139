// When PDOs are taken and sent, by transmission type.
#include "runtime/bus/canopen/pdo.hpp"

namespace ipos::runtime::canopen {
namespace {

enum PdoTimer : uint32_t { kInhibit, kEventTime };

constexpr uint16_t entry_index(uint16_t first, uint8_t number) {
  return static_cast<uint16_t>(first + number);
}

std::optional<uint32_t> id_of(const ObjectDictionary& dictionary, uint16_t index) {
  const uint32_t cob_id = dictionary.value(index, objects::kCobId);
  if ((cob_id & objects::kOff) != 0) return std::nullopt;
  return cob_id & objects::kIdMask;
}

}  // namespace

PdoData pack(const Mapping& mapping, const Words& words) {
  PdoData data{};
  size_t at = 0;
  for (const Mapped& mapped : mapping) {
    if (is_word(mapped)) {
      const uint16_t word = words[static_cast<size_t>(mapped.address.sub - 1)];
      data[at] = static_cast<uint8_t>(word);
      data[at + 1] = static_cast<uint8_t>(word >> 8);
    }
    at += mapped.bits / 8;
  }
  return data;
}

uint16_t unpack(const Mapping& mapping, const PdoData& data, Words& words) {
  unsigned written = 0;
  size_t at = 0;
  for (const Mapped& mapped : mapping) {
    if (is_word(mapped)) {
      const auto word = static_cast<size_t>(mapped.address.sub - 1);
      words[word] = static_cast<uint16_t>(data[at] | data[at + 1] << 8);
      written |= 1U << word;
    }
    at += mapped.bits / 8;
  }
  return static_cast<uint16_t>(written);
}

PdoLayout::PdoLayout(const Mapping& mapping) {
  unsigned at = 0;
  for (const Mapped& mapped : mapping) {
    if (is_word(mapped)) {
      const auto word = static_cast<uint8_t>(mapped.address.sub - 1);
      fields_[count_++] = {static_cast<uint8_t>(at), word};
      words_ = static_cast<uint16_t>(words_ | 1U << word);
    }
    at += mapped.bits / 8U;
  }
  bytes_ = static_cast<uint8_t>(bits_of(mapping) / 8);
}

ReceivePdo::ReceivePdo(ObjectDictionary& dictionary, Unit& unit, uint8_t number)
    : dictionary_(dictionary), unit_(unit), number_(number) {
  configure();
}

void ReceivePdo::configure() {
  const uint16_t index = entry_index(objects::kReceivePdo, number_);
  id_ = id_of(dictionary_, index);
  type_ = static_cast<uint8_t>(dictionary_.value(index, objects::kType));
  layout_ = PdoLayout(mapping_of(dictionary_, entry_index(objects::kReceiveMapping, number_)));
  held_.reset();
}

ReceivePdo::Outcome ReceivePdo::take(Time now, const Frame& frame) {
  const uint8_t bytes = layout_.bytes();
  if (frame.length < bytes) return Outcome::TooShort;
  if (pdo_types::is_synchronous(type_))
    held_ = frame.data;
  else
    deliver(now, frame.data);
  return frame.length > bytes ? Outcome::TooLong : Outcome::Taken;
}

void ReceivePdo::on_sync(Time now) {
  if (!held_) return;
  deliver(now, *held_);
  held_.reset();
}

void ReceivePdo::deliver(Time now, const PdoData& data) {
  Words words{};
  const uint16_t written = layout_.unpack(data, words);
  dictionary_.set_outputs(words, written);
  if (written != 0) unit_.take_output(now, words, written);
}

TransmitPdo::TransmitPdo(const Place& place, const ObjectDictionary& dictionary, Unit& unit, uint8_t number)
    : place_(place),
      dictionary_(dictionary),
      unit_(unit),
      number_(number),
      inhibit_(place, *this, kInhibit),
      event_(place, *this, kEventTime) {
  place_.tag += 1U + number;
}

void TransmitPdo::configure(Time now) {
  const uint16_t index = entry_index(objects::kTransmitPdo, number_);
  const auto value = [&](uint8_t sub) { return dictionary_.value(index, sub); };
  const bool was_on = id_.has_value();
  const uint8_t old_type = type_;
  id_ = id_of(dictionary_, index);
  remote_ = (value(objects::kCobId) & objects::kNoRemote) == 0;
  type_ = static_cast<uint8_t>(value(objects::kType));
  inhibit_time_ = Time{value(objects::kInhibitTime)} * kInhibitUnit;
  event_time_ = Time{value(objects::kEventTimer)} * kMillisecond;
  layout_ = PdoLayout(mapping_of(dictionary_, entry_index(objects::kTransmitMapping, number_)));
  if (!runs_) return;
  if (was_on != id_.has_value() || type_ != old_type) return start(now);
  if (event_time_ == 0)
    event_.stop();
  else if (id_ && pdo_types::is_event(type_))
    event_.start(now + event_time_);
}

// One that is sent on change is sent at the start (ours, as common nodes do it): the receiver knows nothing yet.
void TransmitPdo::start(Time now) {
  stop();
  runs_ = true;
  if (id_ && pdo_types::is_event(type_)) trigger(now);
}

void TransmitPdo::stop() {
  runs_ = false;
  waits_ = false;
  syncs_ = 0;
  last_.reset();
  sampled_.reset();
  inhibit_.stop();
  event_.stop();
}

void TransmitPdo::on_sync(Time now) {
  if (!runs_ || !id_) return;
  if (pdo_types::is_cyclic(type_)) {
    if (++syncs_ < type_) return;
    syncs_ = 0;
    send(now, sample(now));
  } else if (type_ == pdo_types::kSyncOnChange) {
    if (const PdoData data = sample(now); data != last_) send(now, data);
  } else if (type_ == pdo_types::kRemoteAtSync) {
    sampled_ = sample(now);
  }
}

// Types 252 and 253 are for that; one that is sent on events can be asked for as well. Cyclic ones have their SYNC
// (ours).
void TransmitPdo::on_remote(Time now) {
  if (!runs_ || !id_ || !remote_) return;
  if (type_ == pdo_types::kRemoteAtSync)
    send(now, sampled_ ? *sampled_ : sample(now));
  else if (type_ == pdo_types::kRemote)
    send(now, sample(now));
  else if (pdo_types::is_event(type_))
    trigger(now);
}

// One that waits is sent with what the words are then.
void TransmitPdo::inputs_changed(Time now, const Words& words) {
  if (sends_on_change() && layout_.pack(words) != last_) trigger(now);
}

void TransmitPdo::trigger(Time now) {
  if (inhibit_.runs()) {
    waits_ = true;
    return;
  }
  waits_ = false;
  send(now, sample(now));
  if (inhibit_time_ > 0) inhibit_.start(now + inhibit_time_);
  if (event_time_ > 0) event_.start(now + event_time_);
}

void TransmitPdo::on_timer(Time now, uint32_t kind) {
  if (kind == kInhibit && !waits_) return;
  trigger(now);
  unit_.follow_again(now);
}

void TransmitPdo::send(Time /*now*/, const PdoData& data) {
  last_ = data;
  place_.sender.send_latest({*id_, layout_.bytes(), data}, place_.tag);
}

}  // namespace ipos::runtime::canopen
