// The links in turn.
#include "runtime/bus/profibus/fms_partner.hpp"

#include <utility>

namespace ipos::profibus {

fms::ClientLink& FmsPartner::link(const fms::Connection& connection, std::optional<fms::MasterEntry> entry) {
  for (fms::ClientLink& link : links_)
    if (link.connection().cref == connection.cref) return link;
  return links_.emplace_back(connection, entry.value_or(fms::master_entry(connection, address_)));
}

std::optional<FdlFrame> FmsPartner::request(runtime::Time now) {
  for (size_t n = 1; n <= links_.size(); ++n) {
    const size_t turn = (turn_ + n) % links_.size();
    auto data = links_[turn].next(now);
    if (!data) continue;
    turn_ = turn;
    const uint8_t point = links_[turn].connection().lsap;  // of the master the same number (ours)
    const auto code = static_cast<uint8_t>(control::kRequest | sequence_.bits() | static_cast<uint8_t>(FdlRequest::SrdLow));
    return make_frame(address_, master_, code, point, point, std::move(*data));
  }
  return std::nullopt;
}

void FmsPartner::answered(runtime::Time now, const FdlFrame& answer) {
  sequence_.answered();
  fms::ClientLink& link = links_[turn_];
  const bool refused = answer.answers(FdlAnswer::NoService);
  tell(refused ? link.unanswered() : link.answered(now, answer.data));
}

void FmsPartner::unanswered() {
  sequence_ = {};
  tell(links_[turn_].unanswered());
}

void FmsPartner::tell(std::optional<fms::Done> done) {
  if (done) client_.on_done(address_, links_[turn_].connection().cref, *done);
}

}  // namespace ipos::profibus
