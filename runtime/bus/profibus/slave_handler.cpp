// The order of requests, and what each answer means for the next one.
#include "runtime/bus/profibus/slave_handler.hpp"

namespace ipos::profibus {

SlaveHandler::SlaveHandler(uint8_t master, SlavePlan plan)
    : master_(master), plan_(std::move(plan)), outputs_(plan_.outputs), inputs_(plan_.inputs) {
  view_.set(diag::kNonExistent, true);
}

FdlFrame SlaveHandler::make(std::optional<DpService> service, Octets data) {
  const unsigned code = control::kRequest | sequence_.bits() | static_cast<uint8_t>(FdlRequest::SrdHigh);
  std::optional<uint8_t> dsap, ssap;
  if (service) {
    dsap = static_cast<uint8_t>(*service);
    ssap = kMasterAccessPoint;
  }
  return make_frame(plan_.address, master_, static_cast<uint8_t>(code), dsap, ssap, std::move(data));
}

std::optional<FdlFrame> SlaveHandler::request() {
  if (!active_) return std::nullopt;
  switch (state_) {
    case HandlerState::Prm: asked_ = Asked::Prm; return make(DpService::SetPrm, encode(plan_.prm));
    case HandlerState::Cfg: asked_ = Asked::Cfg; return make(DpService::ChkCfg, plan_.cfg);
    case HandlerState::Exchange:
      if (diagnosis_wanted_) break;
      asked_ = Asked::Data;
      return make(std::nullopt, outputs_);
    case HandlerState::FirstDiag:
    case HandlerState::SecondDiag: break;
  }
  asked_ = Asked::Diag;
  return make(DpService::SlaveDiag, {});
}

void SlaveHandler::answered(const FdlFrame& answer) {
  sequence_.answered();
  view_.set(diag::kNonExistent, false);
  switch (asked_) {
    case Asked::Diag: return diagnosed(answer);
    case Asked::Prm:
      state_ = answer.is_acknowledgement() ? HandlerState::Cfg : HandlerState::FirstDiag;
      return;
    case Asked::Cfg:
      state_ = answer.is_acknowledgement() ? HandlerState::SecondDiag : HandlerState::FirstDiag;
      return;
    case Asked::Data: return exchanged(answer);
  }
}

void SlaveHandler::unanswered() {
  view_.set(diag::kNonExistent, true);
  sequence_ = {};
  restart();
}

void SlaveHandler::set_active(bool active) {
  active_ = active;
  view_.set(diag::kDeactivated, !active);
  restart();
}

void SlaveHandler::diagnosed(const FdlFrame& answer) {
  const auto told = decode_diagnosis(answer.data);
  if (!told) {
    view_.set(diag::kInvalidResponse, true);
    return restart();
  }
  view_ = *told;
  const bool foreign = view_.master != kNoMaster && view_.master != master_;
  view_.set(diag::kMasterLock, foreign);
  const bool wants_start =
      view_.has(diag::kPrmFault) || view_.has(diag::kCfgFault) || view_.has(diag::kPrmReq);
  switch (state_) {
    case HandlerState::FirstDiag:
      if (!foreign) state_ = HandlerState::Prm;
      return;
    case HandlerState::SecondDiag:
      if (wants_start) return restart();
      if (view_.has(diag::kNotReady) || view_.has(diag::kStatDiag)) return;
      state_ = HandlerState::Exchange;
      diagnosis_wanted_ = false;
      return;
    case HandlerState::Exchange:
      if (wants_start || view_.has(diag::kNotReady)) return restart();
      diagnosis_wanted_ = view_.has(diag::kStatDiag);
      return;
    case HandlerState::Prm:
    case HandlerState::Cfg: return;  // do not ask for diagnosis
  }
}

void SlaveHandler::exchanged(const FdlFrame& answer) {
  const bool high = answer.answers(FdlAnswer::DataHigh);
  if (answer.data.size() != plan_.inputs || (!high && !answer.answers(FdlAnswer::DataLow))) {
    view_.set(diag::kInvalidResponse, !answer.answers(FdlAnswer::NoService));
    return restart();
  }
  view_.set(diag::kInvalidResponse, false);
  inputs_ = answer.data;
  diagnosis_wanted_ = high;
  ++exchanges_;
}

}  // namespace ipos::profibus
