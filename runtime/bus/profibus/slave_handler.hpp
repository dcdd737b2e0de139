// What a class 1 master does with one slave (EN 50170 volume 2, DP): asks for diagnosis, parameterises,
// configures, asks again, then exchanges data and fetches diagnosis where the slave wants it. One request a
// token; the frame count bit changes with each answer.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "runtime/bus/profibus/dp_service.hpp"
#include "runtime/bus/profibus/fdl_frame.hpp"
#include "runtime/bus/profibus/frame_sequence.hpp"
#include "runtime/bus/profibus/master_partner.hpp"

namespace ipos::profibus {

// The slave as the master's configuration has it.
struct SlavePlan {
  uint8_t address = 0;
  PrmData prm;
  Octets cfg;
  uint8_t inputs = 0;  // octets
  uint8_t outputs = 0;
};

enum class HandlerState : uint8_t { FirstDiag, Prm, Cfg, SecondDiag, Exchange };

class SlaveHandler final : public MasterPartner {
 public:
  SlaveHandler(uint8_t master, SlavePlan plan);

  // The next request; nothing for a slave that is taken out of the cycle.
  std::optional<FdlFrame> request();
  std::optional<FdlFrame> request(Time) override { return request(); }
  // Exactly one of these follows, after all repetitions.
  void answered(const FdlFrame& answer);
  void answered(Time, const FdlFrame& answer) override { answered(answer); }
  void unanswered() override;
  // What came instead of an answer; the request is repeated, or unanswered() follows.
  void garbled() override { view_.set(diag::kInvalidResponse, true); }

  void set_outputs(Octets outputs) { outputs_ = std::move(outputs); }  // as long as planned
  void set_active(bool active);

  const SlavePlan& plan() const { return plan_; }
  HandlerState state() const { return state_; }
  bool exchanging() const { return state_ == HandlerState::Exchange; }
  const Octets& inputs() const { return inputs_; }
  // The diagnosis as last fetched, with the bits that are the master's.
  const Diagnosis& view() const { return view_; }
  uint64_t exchanges() const { return exchanges_; }  // of data, answered

 private:
  enum class Asked : uint8_t { Diag, Prm, Cfg, Data };

  FdlFrame make(std::optional<DpService> service, Octets data);
  void diagnosed(const FdlFrame& answer);
  void exchanged(const FdlFrame& answer);
  void restart() { state_ = HandlerState::FirstDiag; }

  uint8_t master_;
  SlavePlan plan_;
  HandlerState state_ = HandlerState::FirstDiag;
  Asked asked_ = Asked::Diag;
  bool active_ = true;
  bool diagnosis_wanted_ = false;
  FrameSequence sequence_;
  Octets outputs_;
  Octets inputs_;
  Diagnosis view_;
  uint64_t exchanges_ = 0;
};

}  // namespace ipos::profibus
