// A gateway: a DP slave on one side, the master of an SBus on the other. It has no program and no axis. What the DP
// master writes goes to the drives in the order of their SBus addresses, three words each, and what they answer
// goes back. No manual prints a process image, times or a diagnosis of a gateway: what is here is ours
// (docs/reference/protocols/profibus.md).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/movilink/gateway_channel.hpp"
#include "runtime/bus/movilink/sbus_control.hpp"
#include "runtime/bus/movilink/sbus_master.hpp"
#include "runtime/bus/profibus/slave_station.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "runtime/station/control.hpp"
#include "runtime/station/profibus_bus.hpp"

namespace ipos::runtime {

class Gateway final : public Control,
                      private CanNode,
                      private profibus::SlaveUnit,
                      private profibus::SlaveObserver,
                      private EventTarget {
 public:
  // `settings` have a target for each drive, in rising order of the addresses. It joins the PROFIBUS; the SBus with
  // start(). All references must outlive it.
  Gateway(EventQueue& queue, uint32_t source, ProfibusBus& profibus, CanLine& sbus, const ControlConfig& config,
          const GatewayConfig& gateway, ControlSettings settings, Journal& journal);
  ~Gateway() override { queue_.cancel_all(*this); }

  AnyControl self() override { return this; }
  void start() override;

  // Off: it is on neither line. On again it begins as at first; the losses of its drives are counted on.
  void power_off();
  void power_on();
  bool powered() const { return powered_; }

  // One drive, as the gateway sees it.
  struct Drive {
    uint8_t address = 0;
    bool lost = false;    // no answer for longer than the time of an answer
    uint64_t losses = 0;  // how often it was lost
    SbusControl::Answers answers;
    ProcessWords output{};
  };
  size_t drive_count() const { return watched_.size(); }
  Drive drive(size_t n) const;
  std::vector<Drive> drives() const;
  ProcessWords input(size_t n) const;  // as the DP master gets it: 0 of a lost drive
  bool exchanges() const;              // with a DP master
  profibus::SlaveStation& dp() { return dp_; }
  const profibus::SlaveStation& dp() const { return dp_; }
  const GatewayChannel& channel() const { return channel_; }
  uint8_t lost() const { return lost_; }  // a bit for each drive that does not answer, the lowest address first
  const ControlSettings& settings() const { return control_.settings(); }
  const ProfibusUse& profibus() const { return gateway_.profibus; }
  const CanLine& line() const { return line_; }

 private:
  struct Watched {
    bool lost = false;
    uint64_t losses = 0;
  };
  struct Noted {
    profibus::SlaveNote what;
    uint8_t master;
    bool operator==(const Noted&) const = default;
  };

  void on_frame(Time now, const Frame& frame) override;
  void on_sent(Time now, const Frame& frame, uint64_t tag) override;
  bool minds_repeats() const override { return false; }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  void on_bus_off(Time) override { port_->recover(); }
  void on_event(Time now, uint32_t kind, uint64_t argument) override;

  void configured(Time now, const profibus::Configuration& configuration) override;
  void take_outputs(Time now, std::span<const uint8_t> outputs) override;
  void read_inputs(Time now, std::span<uint8_t> inputs) override;
  void watchdog_set(Time, std::optional<Time>) override {}
  void watchdog_expired(Time now) override { exchange_ended(now); }
  void exchange_ended(Time now) override;
  void on_note(Time now, profibus::SlaveNote what, uint8_t master) override;
  void begin();
  bool serves(uint8_t address) const;

  // Hands frames to the line once there is one.
  class Sender final : public FrameSender {
   public:
    void use(FrameSender& line) { line_ = &line; }
    SendStatus send(const Frame& frame, uint64_t tag) override {
      return line_ == nullptr ? SendStatus::NotActive : line_->send(frame, tag);
    }
    void withdraw(uint64_t tag) override {
      if (line_ != nullptr) line_->withdraw(tag);
    }

   private:
    FrameSender* line_ = nullptr;
  };

  EventQueue& queue_;
  uint32_t source_;
  const GatewayConfig& gateway_;
  Journal& journal_;
  Sender sender_;
  CanLine& line_;
  std::unique_ptr<LinePort> port_;
  SbusControl control_;
  SbusMaster master_;
  GatewayChannel channel_;
  profibus::OptionType option_;
  profibus::SlaveStation dp_;
  const profibus::Configuration* configuration_ = nullptr;  // of the data exchange
  ParameterTelegram received_;
  std::vector<Watched> watched_;
  uint8_t lost_ = 0;
  bool powered_ = true;
  Time started_ = 0;
  std::optional<Noted> noted_;  // last; a master that asks on and on is told once
};

}  // namespace ipos::runtime
