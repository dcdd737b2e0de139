// Process data objects of a node: four that it takes and four that it sends, as their entries in the dictionary
// say (CiA 301). What the manual prints of them is the type 1 of the first; the rest is that standard.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "runtime/bus/can/frame.hpp"
#include "runtime/bus/canopen/mapping.hpp"
#include "runtime/bus/canopen/object_dictionary.hpp"
#include "runtime/bus/canopen/place.hpp"
#include "runtime/bus/canopen/unit.hpp"

namespace ipos::runtime::canopen {

namespace pdo_types {
inline constexpr uint8_t kSyncOnChange = 0, kLastCyclic = 240, kRemoteAtSync = 252, kRemote = 253,
                         kEvent = 254;
constexpr bool is_cyclic(uint8_t type) { return type >= 1 && type <= kLastCyclic; }
constexpr bool is_synchronous(uint8_t type) { return type <= kLastCyclic; }
constexpr bool is_event(uint8_t type) { return type >= kEvent; }
}  // namespace pdo_types

using PdoData = std::array<uint8_t, 8>;

// Process words and the bytes of a PDO, low byte first.
PdoData pack(const Mapping& mapping, const Words& words);
// Writes the words that the PDO carries and returns a bit for each, word 1 in bit 0.
uint16_t unpack(const Mapping& mapping, const PdoData& data, Words& words);

// The same of a mapping that was looked at once, for the many PDOs that follow.
class PdoLayout {
 public:
  PdoLayout() = default;
  explicit PdoLayout(const Mapping& mapping);

  uint8_t bytes() const { return bytes_; }
  uint16_t words() const { return words_; }  // that it carries, word 1 in bit 0
  PdoData pack(const Words& words) const {
    PdoData data{};
    for (size_t n = 0; n < count_; ++n) {
      const uint16_t word = words[fields_[n].word];
      data[fields_[n].at] = static_cast<uint8_t>(word);
      data[fields_[n].at + 1U] = static_cast<uint8_t>(word >> 8);
    }
    return data;
  }
  uint16_t unpack(const PdoData& data, Words& words) const {
    for (size_t n = 0; n < count_; ++n)
      words[fields_[n].word] = static_cast<uint16_t>(data[fields_[n].at] | data[fields_[n].at + 1U] << 8);
    return words_;
  }

 private:
  struct Field {
    uint8_t at = 0;    // its low byte
    uint8_t word = 0;  // from 0
  };
  std::array<Field, kPdoBits / 16> fields_{};
  uint8_t count_ = 0;
  uint8_t bytes_ = 0;
  uint16_t words_ = 0;
};

class ReceivePdo {
 public:
  // `number` from 0.
  ReceivePdo(ObjectDictionary& dictionary, Unit& unit, uint8_t number);

  void configure();  // its entries have changed
  std::optional<uint32_t> id() const { return id_; }
  void drop() { held_.reset(); }

  enum class Outcome : uint8_t { Taken, TooShort, TooLong };  // what is too long is taken all the same
  Outcome take(Time now, const Frame& frame);
  void on_sync(Time now);

 private:
  void deliver(Time now, const PdoData& data);

  ObjectDictionary& dictionary_;
  Unit& unit_;
  uint8_t number_;
  std::optional<uint32_t> id_;  // none: off
  uint8_t type_ = 0;
  PdoLayout layout_;
  std::optional<PdoData> held_;  // until the next SYNC
};

class TransmitPdo final : private Timer::Owner {
 public:
  TransmitPdo(const Place& place, const ObjectDictionary& dictionary, Unit& unit, uint8_t number);

  void configure(Time now);  // its entries have changed
  std::optional<uint32_t> id() const { return id_; }
  // Process data are exchanged from now on, or no more.
  void start(Time now);
  void stop();

  void on_sync(Time now);
  void on_remote(Time now);  // a remote frame with its identifier
  void inputs_changed(Time now, const Words& words);
  // It is sent when one of these words changes, PI1 in bit 0, and does not wait for that already.
  bool follows(uint16_t words) const { return (layout_.words() & words) != 0 && sends_on_change(); }

  uint16_t words() const { return layout_.words(); }
  bool sends_on_change() const { return runs_ && id_ && pdo_types::is_event(type_) && !waits_; }

 private:
  void on_timer(Time now, uint32_t kind) override;
  PdoData sample(Time now) { return layout_.pack(unit_.input(now, layout_.words())); }
  void trigger(Time now);
  void send(Time now, const PdoData& data);

  Place place_;
  const ObjectDictionary& dictionary_;
  Unit& unit_;
  uint8_t number_;
  bool runs_ = false;
  std::optional<uint32_t> id_;  // none: off
  bool remote_ = false;         // remote frames are answered
  uint8_t type_ = 0;
  Time inhibit_time_ = 0;
  Time event_time_ = 0;
  PdoLayout layout_;
  uint8_t syncs_ = 0;               // since the last one sent
  std::optional<PdoData> last_;     // sent
  std::optional<PdoData> sampled_;  // at the last SYNC, for a remote frame
  bool waits_ = false;              // for the end of the inhibit time
  Timer inhibit_;
  Timer event_;
};

}  // namespace ipos::runtime::canopen
