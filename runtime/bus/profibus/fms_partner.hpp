// The FMS connections of a master with one station, as frames: one frame count bit for all of them, as the station has one for
// each master. What is done is told to the client.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "runtime/bus/profibus/fms/client_link.hpp"
#include "runtime/bus/profibus/frame_sequence.hpp"
#include "runtime/bus/profibus/master_partner.hpp"

namespace ipos::profibus {

class FmsClient {
 public:
  virtual void on_done(uint8_t address, uint8_t cref, const fms::Done& done) = 0;

 protected:
  ~FmsClient() = default;
};

class FmsPartner final : public MasterPartner {
 public:
  FmsPartner(uint8_t master, uint8_t address, FmsClient& client) : master_(master), address_(address), client_(client) {}

  uint8_t address() const { return address_; }
  // Made where it is not there yet, with the entry that fits all of the slave's or another one.
  fms::ClientLink& link(const fms::Connection& connection, std::optional<fms::MasterEntry> entry = {});

  std::optional<FdlFrame> request(runtime::Time now) override;
  void answered(runtime::Time now, const FdlFrame& answer) override;
  void unanswered() override;

 private:
  void tell(std::optional<fms::Done> done);

  uint8_t master_;
  uint8_t address_;
  FmsClient& client_;
  std::deque<fms::ClientLink> links_;
  size_t turn_ = 0;  // link that was asked for last
  FrameSequence sequence_;
};

}  // namespace ipos::profibus
