// SDO client, step by step.
#include "runtime/bus/canopen/sdo_client.hpp"

#include <algorithm>

namespace ipos::runtime::canopen {
namespace {

constexpr size_t kExpeditedBytes = 4;
constexpr size_t kLongestUpload = 64 * 1024;  // a server that never ends does not fill the memory

}  // namespace

SdoBytes SdoClient::read(Address address) {
  address_ = address;
  step_ = Step::Upload;
  data_.clear();
  return sdo::initiate(sdo::command(sdo::Ask::Upload), address);
}

SdoBytes SdoClient::write(Address address, std::span<const uint8_t> data) {
  address_ = address;
  step_ = Step::Download;
  data_.assign(data.begin(), data.end());
  sent_ = 0;
  if (data.empty() || data.size() > kExpeditedBytes)
    return sdo::initiate(sdo::command(sdo::Ask::Download, sdo::kSized), address,
                         static_cast<uint32_t>(data.size()));
  sent_ = data.size();
  SdoBytes request =
      sdo::initiate(sdo::command(sdo::Ask::Download, static_cast<unsigned>(kExpeditedBytes - sent_) << 2 |
                                                         sdo::kExpedited | sdo::kSized),
                    address);
  std::copy(data.begin(), data.end(), request.begin() + 4);
  return request;
}

std::optional<SdoBytes> SdoClient::finish() {
  step_ = Step::None;
  result_ = std::move(data_);
  return std::nullopt;
}

SdoBytes SdoClient::fail(Abort code) {
  step_ = Step::None;
  result_ = tl::unexpected(static_cast<uint32_t>(code));
  return sdo::abort(address_, code);
}

SdoBytes SdoClient::expire() { return fail(Abort::Timeout); }

std::optional<SdoBytes> SdoClient::take(const SdoBytes& answer) {
  if (!is_busy()) return std::nullopt;
  const sdo::Answer says = sdo::answer_of(answer);
  if (says == sdo::Answer::Abort) {
    step_ = Step::None;
    result_ = tl::unexpected(sdo::data_of(answer));
    return std::nullopt;
  }
  const bool initiates = step_ == Step::Upload || step_ == Step::Download;
  if (initiates && sdo::address_of(answer) != address_) return std::nullopt;  // late, to an earlier request
  switch (step_) {
    case Step::Upload:
      if (says == sdo::Answer::Upload) return take_upload(answer);
      break;
    case Step::UploadSegment:
      if (says == sdo::Answer::UploadSegment) return take_segment(answer);
      break;
    case Step::Download:
      if (says != sdo::Answer::Download) break;
      if (sent_ == data_.size() && !data_.empty()) return finish();
      step_ = Step::DownloadSegment;
      toggle_ = 0;
      return next_segment();
    case Step::DownloadSegment:
      if (says != sdo::Answer::DownloadSegment) break;
      if ((answer[0] & sdo::kToggle) != toggle_) return fail(Abort::Toggle);
      if (sent_ == data_.size()) return finish();
      toggle_ ^= sdo::kToggle;
      return next_segment();
    case Step::None: break;
  }
  return fail(Abort::UnknownCommand);
}

std::optional<SdoBytes> SdoClient::take_upload(const SdoBytes& answer) {
  const bool sized = (answer[0] & sdo::kSized) != 0;
  if ((answer[0] & sdo::kExpedited) != 0) {
    const size_t length = kExpeditedBytes - (sized ? sdo::unused_of_four(answer[0]) : 0U);
    data_.assign(answer.begin() + 4, answer.begin() + 4 + static_cast<ptrdiff_t>(length));
    return finish();
  }
  size_ = sized ? std::optional(sdo::data_of(answer)) : std::nullopt;
  step_ = Step::UploadSegment;
  toggle_ = 0;
  return SdoBytes{sdo::command(sdo::Ask::UploadSegment)};
}

std::optional<SdoBytes> SdoClient::take_segment(const SdoBytes& answer) {
  if ((answer[0] & sdo::kToggle) != toggle_) return fail(Abort::Toggle);
  const size_t length = sdo::kSegment - sdo::unused_of_seven(answer[0]);
  data_.insert(data_.end(), answer.begin() + 1, answer.begin() + 1 + static_cast<ptrdiff_t>(length));
  if (data_.size() > size_.value_or(kLongestUpload)) return fail(Abort::Length);
  if ((answer[0] & sdo::kLast) != 0) {
    if (size_ && data_.size() != *size_) return fail(Abort::Length);
    return finish();
  }
  toggle_ ^= sdo::kToggle;
  return SdoBytes{sdo::command(sdo::Ask::UploadSegment, toggle_)};
}

SdoBytes SdoClient::next_segment() {
  const SdoBytes request =
      sdo::segment(sdo::Ask::DownloadSegment, toggle_, std::span<const uint8_t>(data_).subspan(sent_));
  sent_ = std::min(sent_ + sdo::kSegment, data_.size());
  return request;
}

}  // namespace ipos::runtime::canopen
