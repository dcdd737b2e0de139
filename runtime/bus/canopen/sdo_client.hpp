// The client's side of SDO transfers: reads or writes one object of a server, in one message or in segments. It
// knows no time; who owns it ends a transfer that has no answer.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/bus/canopen/sdo.hpp"

namespace ipos::runtime::canopen {

class SdoClient {
 public:
  // Both begin a transfer and return its first request.
  SdoBytes read(Address address);
  SdoBytes write(Address address, std::span<const uint8_t> data);  // more than four bytes: in segments

  // What to send after an answer: the next request, or an abort that ends the transfer. Nothing when it has ended
  // or the answer was not to it.
  std::optional<SdoBytes> take(const SdoBytes& answer);
  SdoBytes expire();  // no answer came: the abort to send

  bool is_busy() const { return step_ != Step::None; }
  Address address() const { return address_; }
  // Of the transfer that has ended: what was read, or the abort code of either side.
  const tl::expected<std::vector<uint8_t>, uint32_t>& result() const { return result_; }

 private:
  enum class Step : uint8_t { None, Upload, UploadSegment, Download, DownloadSegment };

  std::optional<SdoBytes> take_upload(const SdoBytes& answer);
  std::optional<SdoBytes> take_segment(const SdoBytes& answer);
  SdoBytes next_segment();
  std::optional<SdoBytes> finish();
  SdoBytes fail(Abort code);

  Step step_ = Step::None;
  Address address_;
  uint8_t toggle_ = 0;
  std::vector<uint8_t> data_;
  size_t sent_ = 0;
  std::optional<uint32_t> size_;
  tl::expected<std::vector<uint8_t>, uint32_t> result_;
};

}  // namespace ipos::runtime::canopen
