// Layer 2 first: whom a frame is for, whether it repeats the last one, which function. Then the services by
// their access points.
#include "runtime/bus/profibus/dp_slave.hpp"

#include <utility>

namespace ipos::profibus {
namespace {

constexpr uint8_t kFirstAcyclic = 49, kLastAcyclic = 53;  // access points of DP-V1

bool is_srd(const FdlFrame& frame) {
  return frame.asks(FdlRequest::SrdLow) || frame.asks(FdlRequest::SrdHigh);
}
bool is_sdn(const FdlFrame& frame) {
  return frame.asks(FdlRequest::SdnLow) || frame.asks(FdlRequest::SdnHigh);
}

FdlFrame status_answer(const FdlFrame& request, FdlAnswer answer) {
  return make_frame(request.source, request.destination, static_cast<uint8_t>(answer));
}

SlaveNote why_no_access_point(uint8_t point) {
  if (point >= kFirstAcyclic && point <= kLastAcyclic) return SlaveNote::NoAcyclic;
  if (fms::connection_at(point) != nullptr) return SlaveNote::NoFms;
  return SlaveNote::NoAccessPoint;
}

}  // namespace

std::string_view slave_note_text(SlaveNote note) {
  static constexpr std::string_view kTexts[] = {
#define SLAVE_NOTE(name, text) text,
#include "runtime/bus/profibus/slave_notes.def"
  };
  return kTexts[static_cast<size_t>(note)];
}

void DpSlave::power_on(Time now, SlaveSettings settings) {
  settings_ = settings;
  state_ = SlaveState::WaitPrm;
  master_ = kNoMaster;
  min_tsdr_ = settings.min_tsdr;
  prm_ = {};
  configuration_ = nullptr;
  cfg_data_ = {};
  for (const Configuration& row : configurations(settings.accepts.set))
    if (cfg_data_.empty() && row.words >= settings.accepts.least) cfg_data_ = row.cfg_data();
  prm_fault_ = cfg_fault_ = not_supported_ = static_diagnosis_ = was_parameterised_ = false;
  fault_told_.reset();
  image_.begin(0);
  fault_.power_on(now);
  frame_count_ = {};
}

void DpSlave::note(Time now, SlaveNote what, uint8_t master) {
  if (observer_ != nullptr) observer_->on_note(now, what, master);
}

// --- layer 2

std::optional<FdlFrame> DpSlave::on_frame(Time now, const FdlFrame& frame) {
  if (!frame.is_request() || settings_.address > kLastStation) return std::nullopt;
  if (is_sdn(frame)) {
    if (frame.destination != kBroadcast && frame.destination != settings_.address) return std::nullopt;
    if (frame.dsap == static_cast<uint8_t>(DpService::GlobalControl)) control(now, frame);
    return std::nullopt;
  }
  if (frame.destination != settings_.address) return std::nullopt;
  if (is_master(frame)) last_heard_ = now;
  if (frame.asks(FdlRequest::FdlStatus)) return status_answer(frame, FdlAnswer::Ok);
  if (const FdlFrame* stored = frame_count_.repeated(frame)) return *stored;
  FdlFrame answer;
  if (is_srd(frame))
    answer = respond(now, frame);
  else if (frame.asks(FdlRequest::SdaLow) || frame.asks(FdlRequest::SdaHigh) ||
           frame.asks(FdlRequest::Ident) || frame.asks(FdlRequest::LsapStatus))
    answer = status_answer(frame, FdlAnswer::NoService);
  else
    return std::nullopt;  // a function of no number
  frame_count_.store(frame, answer);
  return answer;
}

FdlFrame DpSlave::data_answer(const FdlFrame& request, Octets data, FdlAnswer answer) const {
  return make_frame(request.source, settings_.address, static_cast<uint8_t>(answer), request.ssap,
                    request.dsap, std::move(data));
}

FdlFrame DpSlave::refuse(Time now, const FdlFrame& request, SlaveNote why) {
  note(now, why, request.source);
  return status_answer(request, FdlAnswer::NoService);
}

FdlFrame DpSlave::respond(Time now, const FdlFrame& request) {
  if (!request.dsap && !request.ssap) return exchange(now, request);
  if (fms_ != nullptr && request.dsap && request.ssap && fms::connection_at(*request.dsap) != nullptr)
    return serve_fms(now, request);
  const auto service = request.dsap ? dp_service(*request.dsap) : std::nullopt;
  if (!service || request.ssap != kMasterAccessPoint)
    return refuse(now, request, why_no_access_point(request.dsap.value_or(0)));
  return serve(now, request, *service);
}

// Any access point of any master: the connections are open ones.
FdlFrame DpSlave::serve_fms(Time now, const FdlFrame& request) {
  fms::LinkAnswer answer = fms_->take(now, *request.dsap, {request.source, *request.ssap}, request.data);
  if (answer.refused) return refuse(now, request, SlaveNote::FmsPartner);
  using Event = fms::LinkAnswer::Event;
  if (answer.event != Event::None)
    note(now, answer.event == Event::Opened ? SlaveNote::FmsOpened : SlaveNote::FmsEnded, request.source);
  return answer.data.empty() ? make_acknowledgement() : data_answer(request, std::move(answer.data));
}

// --- services

FdlFrame DpSlave::serve(Time now, const FdlFrame& request, DpService service) {
  switch (service) {
    case DpService::SlaveDiag: {
      const Diagnosis told = diagnosis(now);
      if (is_master(request)) fault_told_ = told.fault;
      return data_answer(request, encode(told));
    }
    case DpService::GetCfg: return data_answer(request, cfg_data_);
    case DpService::SetPrm: return parameterise(now, request);
    case DpService::ChkCfg: return configure(now, request);
    case DpService::ReadInputs:
      if (state_ != SlaveState::DataExchange) return refuse(now, request, SlaveNote::NotExchanging);
      return data_answer(request, inputs(now));
    case DpService::ReadOutputs:
      if (state_ != SlaveState::DataExchange) return refuse(now, request, SlaveNote::NotExchanging);
      return data_answer(request, image_.outputs());
    case DpService::SetSlaveAddress:
      not_supported_ = true;
      return refuse(now, request, SlaveNote::NoSetAddress);
    case DpService::GlobalControl: break;  // is sent without wanting an answer
  }
  return refuse(now, request, SlaveNote::NoAccessPoint);
}

std::optional<SlaveNote> DpSlave::fault_of(std::span<const uint8_t> octets,
                                           const std::optional<PrmData>& prm) const {
  if (octets.size() != kPrmSize) return SlaveNote::PrmLength;
  if (prm->reserved != 0) return SlaveNote::PrmReserved;
  if (prm->min_tsdr != 0 && prm->min_tsdr < kLeastMinTsdr) return SlaveNote::PrmMinTsdr;
  if (!prm->lock || prm->unlock) return std::nullopt;  // the rest is not taken
  if (prm->ident != settings_.ident) return SlaveNote::PrmIdent;
  if (prm->watchdog && prm->watchdog_time() == 0) return SlaveNote::PrmWatchdog;
  return std::nullopt;
}

// A wrong Set_Prm is acknowledged like a good one; the fault shows in the diagnosis.
FdlFrame DpSlave::parameterise(Time now, const FdlFrame& request) {
  if (state_ != SlaveState::WaitPrm && !is_master(request))
    return refuse(now, request, SlaveNote::OtherMaster);
  const auto prm = decode_prm(request.data);
  not_supported_ = false;
  if (const auto fault = fault_of(request.data, prm)) {
    prm_fault_ = true;
    not_supported_ = *fault == SlaveNote::PrmReserved;
    wait_for_prm(now, *fault, request.source);
  } else if (prm->unlock) {
    wait_for_prm(now, SlaveNote::Unlocked, request.source);
  } else {
    if (prm->min_tsdr != 0) min_tsdr_ = prm->min_tsdr;
    if (prm->lock) take_prm(now, request, *prm);
  }
  return make_acknowledgement();
}

void DpSlave::take_prm(Time now, const FdlFrame& request, const PrmData& prm) {
  prm_fault_ = false;
  was_parameterised_ = true;
  prm_ = prm;
  master_ = request.source;
  fault_told_.reset();
  last_heard_ = now;
  if (state_ == SlaveState::WaitPrm) state_ = SlaveState::WaitCfg;
  unit_.watchdog_set(now, prm.watchdog ? std::optional(prm.watchdog_time()) : std::nullopt);
  note(now, SlaveNote::Parameterised, request.source);
}

FdlFrame DpSlave::configure(Time now, const FdlFrame& request) {
  if (state_ == SlaveState::WaitPrm) {
    note(now, SlaveNote::CfgTooEarly, request.source);
    return make_acknowledgement();
  }
  if (!is_master(request)) return refuse(now, request, SlaveNote::OtherMaster);
  const Configuration* wanted = find_configuration(request.data, settings_.accepts);
  if (wanted == nullptr) {
    cfg_fault_ = true;
    wait_for_prm(now, SlaveNote::CfgRefused, request.source);
    return make_acknowledgement();
  }
  cfg_fault_ = false;
  cfg_data_ = request.data;
  if (state_ == SlaveState::DataExchange && wanted == configuration_) return make_acknowledgement();
  state_ = SlaveState::DataExchange;
  configuration_ = wanted;
  image_.begin(wanted->octets);
  unit_.configured(now, *wanted);
  note(now, SlaveNote::Configured, request.source);
  return make_acknowledgement();
}

FdlFrame DpSlave::exchange(Time now, const FdlFrame& request) {
  if (state_ != SlaveState::DataExchange) return refuse(now, request, SlaveNote::NotExchanging);
  if (!is_master(request)) return refuse(now, request, SlaveNote::OtherMaster);
  if (request.data.size() != image_.size()) {
    cfg_fault_ = true;
    wait_for_prm(now, SlaveNote::DataLength, request.source);
    return status_answer(request, FdlAnswer::NoService);
  }
  unit_.exchanged(now);
  if (image_.take(request.data)) unit_.take_outputs(now, image_.outputs());
  const bool diagnosis_waits = static_diagnosis_ || fault_.shown(now) != fault_told_;
  return data_answer(request, inputs(now), diagnosis_waits ? FdlAnswer::DataHigh : FdlAnswer::DataLow);
}

void DpSlave::control(Time now, const FdlFrame& request) {
  if (state_ != SlaveState::DataExchange || !is_master(request) || request.data.size() != 2) return;
  const GlobalCommand command{request.data[0], request.data[1]};
  if (!command.addresses(prm_.groups)) return;
  bool act = command.clears() && image_.clear();
  if (command.unsyncs()) act |= image_.unsync();
  if (command.syncs()) {
    if (prm_.sync)
      act |= image_.sync();
    else
      note(now, SlaveNote::SyncNotRequested, request.source);
  }
  if (act) unit_.take_outputs(now, image_.outputs());
  if (command.unfreezes()) image_.unfreeze();
  if (command.freezes()) {
    if (!prm_.freeze) return note(now, SlaveNote::FreezeNotRequested, request.source);
    image_.unfreeze();
    image_.freeze(inputs(now));
  }
}

// --- state

void DpSlave::wait_for_prm(Time now, SlaveNote why, uint8_t master) {
  const bool exchanged = std::exchange(state_, SlaveState::WaitPrm) == SlaveState::DataExchange;
  master_ = kNoMaster;
  prm_ = {};
  configuration_ = nullptr;
  image_.end_modes();
  note(now, why, master);
  if (why == SlaveNote::WatchdogExpired)
    unit_.watchdog_expired(now);
  else if (exchanged)
    unit_.exchange_ended(now);
}

Time DpSlave::watchdog_deadline() const {
  return prm_.watchdog ? last_heard_ + prm_.watchdog_time() : runtime::kNever;
}

void DpSlave::expire(Time now) {
  if (now < watchdog_deadline()) return;
  wait_for_prm(now, SlaveNote::WatchdogExpired, kNoMaster);
}

Octets DpSlave::inputs(Time now) {
  if (image_.is_frozen()) return image_.frozen();
  Octets octets(image_.size());
  unit_.read_inputs(now, octets);
  return octets;
}

Diagnosis DpSlave::diagnosis(Time now) {
  Diagnosis diagnosis;
  diagnosis.master = master_;
  diagnosis.ident = settings_.ident;
  diagnosis.fault = fault_.shown(now);
  diagnosis.set(diag::kPrmFault, prm_fault_);
  diagnosis.set(diag::kNotSupported, not_supported_);
  diagnosis.set(diag::kExtDiag, diagnosis.fault.has_value());
  diagnosis.set(diag::kCfgFault, cfg_fault_);
  diagnosis.set(diag::kNotReady, state_ != SlaveState::DataExchange);
  diagnosis.set(diag::kSyncMode, image_.synced());
  diagnosis.set(diag::kFreezeMode, image_.is_frozen());
  diagnosis.set(diag::kWatchdogOn, prm_.watchdog);
  diagnosis.set(diag::kStatDiag, static_diagnosis_);
  diagnosis.set(diag::kPrmReq, state_ == SlaveState::WaitPrm);
  return diagnosis;
}

}  // namespace ipos::profibus
