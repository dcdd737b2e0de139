// The SDO server of a node: expedited and segmented transfers, one at a time. It knows no time; who owns it
// ends a transfer whose client has fallen silent.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/bus/canopen/object_access.hpp"
#include "runtime/bus/canopen/sdo.hpp"

namespace ipos::runtime::canopen {

class SdoServer {
 public:
  explicit SdoServer(ObjectServer& objects) : objects_(objects) {}

  // The answer to a request; nothing to a client's abort.
  std::optional<SdoBytes> take(Time now, const SdoBytes& request);

  bool is_busy() const { return transfer_ != Transfer::None; }  // between the segments of a transfer
  SdoBytes expire();                                            // of a busy one: the abort to send
  void reset() { transfer_ = Transfer::None; }

 private:
  enum class Transfer : uint8_t { None, Download, Upload };

  SdoBytes download(Time now, const SdoBytes& request);
  SdoBytes download_segment(Time now, const SdoBytes& request);
  SdoBytes upload(Time now, Address address);
  SdoBytes upload_segment(const SdoBytes& request);
  SdoBytes abort(Abort code);
  bool has_toggled(const SdoBytes& request) const { return (request[0] & sdo::kToggle) == toggle_; }

  ObjectServer& objects_;
  Transfer transfer_ = Transfer::None;
  Address address_;
  uint8_t toggle_ = 0;  // of the next segment
  std::optional<uint32_t> size_;
  std::vector<uint8_t> data_;
  size_t sent_ = 0;
};

}  // namespace ipos::runtime::canopen
