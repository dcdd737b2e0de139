// A DP slave as MOVITRAC 31, the cards of MOVIDRIVE and the gateway have it: the whole of DP-V0 after the frames of layer 2, as a pure machine: frames
// and times in, answers out. The line, the automatic rate and the delay of the answer are the station's.
//
// States and what is not printed (which requests of other masters get RS, what leads back to Wait_Prm) are
// told in docs/reference/protocols/profibus.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "runtime/bus/profibus/cfg_data.hpp"
#include "runtime/bus/profibus/dp_service.hpp"
#include "runtime/bus/profibus/fdl_frame.hpp"
#include "runtime/bus/profibus/fms/slave_links.hpp"
#include "runtime/bus/profibus/frame_count.hpp"
#include "runtime/bus/profibus/process_image.hpp"
#include "runtime/bus/profibus/unit_fault.hpp"

namespace ipos::profibus {

enum class SlaveState : uint8_t { WaitPrm, WaitCfg, DataExchange };

enum class SlaveNote : uint8_t {
#define SLAVE_NOTE(name, text) name,
#include "runtime/bus/profibus/slave_notes.def"
};
std::string_view slave_note_text(SlaveNote note);

// The unit behind the slave.
class SlaveUnit {
 public:
  // Data exchange begins, with all outputs 0.
  virtual void configured(Time now, const Configuration& configuration) = 0;
  virtual void take_outputs(Time now, std::span<const uint8_t> outputs) = 0;
  // The master exchanged data, whatever became of the outputs: in Sync mode they wait.
  virtual void exchanged(Time /*now*/) {}
  // Fills as many octets as are configured.
  virtual void read_inputs(Time now, std::span<uint8_t> inputs) = 0;
  // The watchdog time of Set_Prm; nothing: no watchdog.
  virtual void watchdog_set(Time now, std::optional<Time> period) = 0;
  virtual void watchdog_expired(Time now) = 0;
  // The master ended the data exchange, or broke its rules.
  virtual void exchange_ended(Time now) = 0;

 protected:
  ~SlaveUnit() = default;
};

class SlaveObserver {
 public:
  // `master` is who asked, kNoMaster for what happens by itself.
  virtual void on_note(Time now, SlaveNote note, uint8_t master) = 0;
  // The link from the card to the unit is lost, or there again.
  virtual void on_link(Time /*now*/, bool /*lost*/) {}

 protected:
  ~SlaveObserver() = default;
};

struct SlaveSettings {
  uint8_t address = kNoAddressYet;  // beyond kLastStation the slave is silent
  uint16_t ident = 0;
  uint8_t min_tsdr = kLeastMinTsdr;  // bit times, until a master sets another one
  AcceptedWords accepts{};
};

class DpSlave {
 public:
  DpSlave(SlaveSettings settings, SlaveUnit& unit, SlaveObserver* observer = nullptr)
      : settings_(settings), unit_(unit), observer_(observer) {
    power_on(0, settings);
  }

  void power_on(Time now, SlaveSettings settings);
  // The connections of FMS behind access points 20 to 26; it must outlive the slave.
  void set_fms(fms::SlaveLinks& links) { fms_ = &links; }

  // An error-free frame on the line, and what the slave answers.
  std::optional<FdlFrame> on_frame(Time now, const FdlFrame& frame);

  // When the watchdog runs out; kNever without. At that time expire() is due.
  Time watchdog_deadline() const;
  void expire(Time now);

  void set_fault(Time now, std::optional<uint8_t> fault) { fault_.set(now, fault); }
  // The unit has no valid data for the moment: the master is to fetch diagnosis until this ends.
  void set_static_diagnosis(bool on) { static_diagnosis_ = on; }
  void set_min_tsdr(uint8_t bits) { min_tsdr_ = bits; }

  SlaveState state() const { return state_; }
  bool was_parameterised() const { return was_parameterised_; }  // by a master of DP, since the last power-on
  uint8_t address() const { return settings_.address; }
  uint8_t min_tsdr() const { return min_tsdr_; }
  const Configuration* configuration() const { return configuration_; }  // of the data exchange
  const Octets& outputs() const { return image_.outputs(); }
  Diagnosis diagnosis(Time now);

 private:
  FdlFrame respond(Time now, const FdlFrame& request);
  FdlFrame exchange(Time now, const FdlFrame& request);
  FdlFrame serve_fms(Time now, const FdlFrame& request);
  FdlFrame serve(Time now, const FdlFrame& request, DpService service);
  FdlFrame parameterise(Time now, const FdlFrame& request);
  FdlFrame configure(Time now, const FdlFrame& request);
  void control(Time now, const FdlFrame& request);
  std::optional<SlaveNote> fault_of(std::span<const uint8_t> octets, const std::optional<PrmData>& prm) const;
  void take_prm(Time now, const FdlFrame& request, const PrmData& prm);
  void wait_for_prm(Time now, SlaveNote note, uint8_t master);
  Octets inputs(Time now);
  bool is_master(const FdlFrame& request) const { return request.source == master_; }
  FdlFrame data_answer(const FdlFrame& request, Octets data, FdlAnswer answer = FdlAnswer::DataLow) const;
  FdlFrame refuse(Time now, const FdlFrame& request, SlaveNote note);
  void note(Time now, SlaveNote what, uint8_t master);

  SlaveSettings settings_;
  SlaveUnit& unit_;
  SlaveObserver* observer_;
  fms::SlaveLinks* fms_ = nullptr;
  SlaveState state_ = SlaveState::WaitPrm;
  uint8_t master_ = kNoMaster;  // that of Set_Prm
  uint8_t min_tsdr_ = kLeastMinTsdr;
  PrmData prm_;          // of the master
  Time last_heard_ = 0;  // from the master
  const Configuration* configuration_ = nullptr;
  Octets cfg_data_;  // accepted last
  bool prm_fault_ = false;
  bool cfg_fault_ = false;
  bool not_supported_ = false;
  bool static_diagnosis_ = false;
  bool was_parameterised_ = false;
  std::optional<uint8_t> fault_told_;  // that the master has fetched
  ProcessImage image_;
  UnitFault fault_;
  FrameCount frame_count_;
};

}  // namespace ipos::profibus
