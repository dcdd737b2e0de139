// SDO server, command by command.
#include "runtime/bus/canopen/sdo_server.hpp"

#include <algorithm>

namespace ipos::runtime::canopen {
namespace {

// No object that can be written is longer than this.
constexpr size_t kLongestDownload = 4;

}  // namespace

// A new initiate in the middle of a transfer begins a new one: the client has started again (ours).
std::optional<SdoBytes> SdoServer::take(Time now, const SdoBytes& request) {
  switch (sdo::ask_of(request)) {
    case sdo::Ask::Download: return download(now, request);
    case sdo::Ask::Upload: return upload(now, sdo::address_of(request));
    case sdo::Ask::DownloadSegment: return download_segment(now, request);
    case sdo::Ask::UploadSegment: return upload_segment(request);
    case sdo::Ask::Abort: transfer_ = Transfer::None; return std::nullopt;
    case sdo::Ask::BlockUpload:
    case sdo::Ask::BlockDownload:
    case sdo::Ask::None: break;
  }
  address_ = sdo::address_of(request);
  return abort(Abort::UnknownCommand);
}

SdoBytes SdoServer::expire() { return abort(Abort::Timeout); }

SdoBytes SdoServer::abort(Abort code) {
  transfer_ = Transfer::None;
  return sdo::abort(address_, code);
}

SdoBytes SdoServer::download(Time now, const SdoBytes& request) {
  const uint8_t byte0 = request[0];
  address_ = sdo::address_of(request);
  transfer_ = Transfer::None;
  if (const auto refused = objects_.refuses(now, address_)) return abort(*refused);
  if ((byte0 & sdo::kExpedited) != 0) {
    // Without a length told it is what the object takes: as long as the object, if that is four bytes or less.
    size_t length = 4U - ((byte0 & sdo::kSized) != 0 ? sdo::unused_of_four(byte0) : 0U);
    if ((byte0 & sdo::kSized) == 0)
      if (const auto present = objects_.read(now, address_)) length = std::min(length, present->size());
    if (const auto refused = objects_.write(now, address_, {request.data() + 4, length}))
      return abort(*refused);
    return sdo::initiate(sdo::command(sdo::Answer::Download), address_);
  }
  size_.reset();
  if ((byte0 & sdo::kSized) != 0) size_ = sdo::data_of(request);
  if (size_.value_or(0) > kLongestDownload) return abort(Abort::Length);
  transfer_ = Transfer::Download;
  toggle_ = 0;
  data_.clear();
  return sdo::initiate(sdo::command(sdo::Answer::Download), address_);
}

SdoBytes SdoServer::download_segment(Time now, const SdoBytes& request) {
  if (transfer_ != Transfer::Download) {
    if (transfer_ == Transfer::None) address_ = {};
    return abort(Abort::UnknownCommand);
  }
  if (!has_toggled(request)) return abort(Abort::Toggle);
  const size_t length = sdo::kSegment - sdo::unused_of_seven(request[0]);
  if (data_.size() + length > kLongestDownload) return abort(Abort::Length);
  data_.insert(data_.end(), request.begin() + 1, request.begin() + 1 + static_cast<ptrdiff_t>(length));
  if ((request[0] & sdo::kLast) != 0) {
    if (size_ && *size_ != data_.size()) return abort(Abort::Length);
    if (const auto refused = objects_.write(now, address_, data_)) return abort(*refused);
    transfer_ = Transfer::None;
  }
  const SdoBytes answer = {sdo::command(sdo::Answer::DownloadSegment, toggle_)};
  toggle_ ^= sdo::kToggle;
  return answer;
}

SdoBytes SdoServer::upload(Time now, Address address) {
  address_ = address;
  transfer_ = Transfer::None;
  auto value = objects_.read(now, address);
  if (!value) return abort(value.error());
  data_ = std::move(*value);
  const size_t size = data_.size();
  if (size > 4 || size == 0) {
    transfer_ = Transfer::Upload;
    toggle_ = 0;
    sent_ = 0;
    return sdo::initiate(sdo::command(sdo::Answer::Upload, sdo::kSized), address,
                         static_cast<uint32_t>(size));
  }
  uint32_t packed = 0;
  for (size_t n = 0; n < size; ++n) packed |= uint32_t{data_[n]} << 8 * n;
  const auto unused = static_cast<unsigned>(4 - size);
  return sdo::initiate(sdo::command(sdo::Answer::Upload, unused << 2 | sdo::kExpedited | sdo::kSized),
                       address, packed);
}

SdoBytes SdoServer::upload_segment(const SdoBytes& request) {
  if (transfer_ != Transfer::Upload) {
    if (transfer_ == Transfer::None) address_ = {};
    return abort(Abort::UnknownCommand);
  }
  if (!has_toggled(request)) return abort(Abort::Toggle);
  const SdoBytes answer =
      sdo::segment(sdo::Answer::UploadSegment, toggle_, std::span<const uint8_t>(data_).subspan(sent_));
  sent_ = std::min(sent_ + sdo::kSegment, data_.size());
  toggle_ ^= sdo::kToggle;
  if ((answer[0] & sdo::kLast) != 0) transfer_ = Transfer::None;
  return answer;
}

}  // namespace ipos::runtime::canopen
