// Rows of the pages, from parameters, ports and lines.
#include "tools/unit/diag_pages.hpp"

#include <fmt/format.h>

#include <utility>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/movilink/identifiers.hpp"
#include "runtime/bus/profibus/frame_text.hpp"
#include "runtime/drive/control.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::tools {
namespace {

using runtime::CanLine;
using runtime::Frame;

std::string line(std::string_view name, std::string_view value) {
  return fmt::format("  {:<32} {}\n", name, value);
}

std::string word(uint16_t value) { return fmt::format("{:04X} hex", value); }

constexpr std::string_view slave_text(profibus::SlaveState state) {
  switch (state) {
    case profibus::SlaveState::WaitPrm: return "waits for parameters (Wait_Prm)";
    case profibus::SlaveState::WaitCfg: return "waits for its configuration (Wait_Cfg)";
    case profibus::SlaveState::DataExchange: break;
  }
  return "exchanges data";
}

std::string dp_lines(profibus::SlaveStation& station, runtime::Time now) {
  profibus::DpSlave& slave = station.slave();
  const profibus::Diagnosis diagnosis = slave.diagnosis(now);
  std::string text = line("address", fmt::format("{}", slave.address()));
  text += line("ident number", word(diagnosis.ident));
  text += line("state", slave_text(slave.state()));
  text +=
      line("master", diagnosis.master == profibus::kNoMaster ? "none" : fmt::format("{}", diagnosis.master));
  if (const profibus::Configuration* configuration = slave.configuration())
    text += line("configuration", configuration->name);
  const auto octets = profibus::encode(diagnosis);
  return text + line("Slave_Diag", profibus::hex_text(octets));
}

constexpr std::string_view state_text(runtime::ErrorState state) {
  switch (state) {
    case runtime::ErrorState::Active: return "error active";
    case runtime::ErrorState::Passive: return "error passive";
    case runtime::ErrorState::BusOff: break;
  }
  return "bus off";
}

}  // namespace

DiagPages::DiagPages(runtime::Plant& plant, runtime::Station& station, runtime::CanNames names)
    : plant_(plant), station_(station), words_(std::move(names)) {
  CanObserver& observer = *this;
  plant.add_observer(observer);
}

// A telegram of the unit's own address, or of its node.
bool DiagPages::concerns(const CanLine& line, const Frame& frame) const {
  for (const int number : {1, 2}) {
    if (const auto* port = station_.sbus(number); port != nullptr && &port->line() == &line)
      if (const auto identifier = runtime::classify_identifier(frame.id))
        return !telegram_type(identifier->telegram).grouped &&
               identifier->address == port->settings().slave.address;
    if (const auto* port = station_.canopen(number); port != nullptr && &port->line() == &line)
      if (const auto addressed = runtime::canopen::connection_of(frame.id))
        return addressed->node == port->settings().canopen_address;
  }
  return false;
}

void DiagPages::on_frame(const CanLine& line, const runtime::FrameRecord& record) {
  const std::string text = words_.describe(line.name(), record.frame).text;
  Heard& heard = heard_[&line];
  const bool own =
      record.sender != runtime::kNoNode && line.node_name(record.sender) == station_.config().name;
  ++(own ? heard.sent : heard.received);
  const bool parameter = runtime::is_plain(record.frame) && record.frame.length == 8 &&
                         concerns(line, record.frame) && text.find(" PI") == std::string::npos;
  if (!parameter) return;
  const auto identifier = runtime::classify_identifier(record.frame.id);
  const auto addressed = runtime::canopen::connection_of(record.frame.id);
  const bool sdo = addressed && (addressed->connection == runtime::canopen::Connection::SdoRequest ||
                                 addressed->connection == runtime::canopen::Connection::SdoResponse);
  if (!sdo && !(identifier && telegram_type(identifier->telegram).parameter)) return;
  ++heard.parameters;
  heard.last_parameter = text;
}

std::string DiagPages::row(std::string_view number) const {
  const stdlib::Parameter* parameter = stdlib::parameter_table(*station_.config().unit).find(number);
  if (parameter == nullptr) return {};
  return line(fmt::format("P{} {}", number, parameter->name),
              stdlib::parameter_text(*parameter, station_.read(parameter->index)));
}

std::string DiagPages::parameters() const {
  std::string text = row("803") + row("802");
  for (const auto& [can, heard] : heard_) {
    if (heard.parameters == 0) continue;
    text += line(fmt::format("telegrams on {}", can->name()), fmt::format("{}", heard.parameters));
    text += line("last", heard.last_parameter);
  }
  for (const auto& entry : plant_.journal().entries())
    if (entry.station == station_.config().name && entry.text.starts_with("refused "))
      text += line(fmt::format("refused at {} ms", entry.time / runtime::kMillisecond), entry.text.substr(8));
  return text;
}

std::string DiagPages::process_data() const {
  const runtime::Drive& drive = station_.drive().state();
  std::string text = row("100") + row("101") + row("876");
  for (const char* number : {"870", "871", "872"}) text += row(number);
  for (size_t n = 0; n < drive.po().size(); ++n)
    text += line(fmt::format("PO{}", n + 1), word(drive.po()[n]));
  const auto further = [&](std::string_view name, const runtime::FurtherWords& words) {
    for (size_t n = 0; station_.has_further_words() && n < words.size(); ++n)
      text += line(fmt::format("{}{}", name, drive.po().size() + n + 1), word(words[n]));
  };
  further("PO", drive.further_po());
  for (const char* number : {"873", "874", "875"}) text += row(number);
  const auto pi = drive.pi();
  for (size_t n = 0; n < pi.size(); ++n) text += line(fmt::format("PI{}", n + 1), word(pi[n]));
  further("PI", drive.further_pi());
  text += line("PO data enabled", drive.po_data_enabled() ? "yes" : "no");
  text += line("status word 1", word(drive.status_word_1()));
  text += line("state", condition_text(drive.condition()));
  const runtime::Verdict verdict = drive.verdict();
  if (verdict.reason != runtime::Block::None) text += line("not enabled", block_text(verdict.reason, *station_.config().unit));
  if (const auto note = drive.setpoint().note; note != runtime::SetpointNote::None)
    text += line("setpoint", setpoint_note_text(note, *station_.config().unit));
  return text;
}

std::string DiagPages::rs485() const {
  const runtime::SerialConfig& serial = station_.config().serial;
  std::string text;
  for (const char* number : {"810", "811", "812", "833", "750", "751"}) text += row(number);
  text += line("X13", serial.x13.bus.empty() ? "not connected" : serial.x13.bus);
  text += line("XT", serial.keypad ? "keypad" : serial.xt.bus.empty() ? "not connected" : serial.xt.bus);
  text += line("timeouts (F43)", fmt::format("{}", station_.drive().state().rs485_timeouts()));
  return text;
}

std::string DiagPages::can() const {
  std::string text;
  for (const int number : {1, 2}) {
    const runtime::SbusPort* port = station_.sbus(number);
    const runtime::CanopenPort* canopen = station_.canopen(number);
    if (port == nullptr && canopen == nullptr) continue;
    const CanLine& can = port != nullptr ? port->line() : canopen->line();
    const runtime::NodeId node = port != nullptr ? port->node() : canopen->node();
    text += fmt::format("SBus {} on {}\n", number, can.name());
    const bool renumbered = station_.config().unit->has(stdlib::Trait::NewSbusNumbers);
    const std::string group = !renumbered ? "81" : number == 1 ? "88" : "89";
    for (const char* digit : {"0", "1", "2", "3", "4", "5", "6"}) text += row(group + digit);
    text += row(number == 1 ? "836" : "837");
    text += line("rate of the line", fmt::format("{} kbaud", can.baud() / 1000));
    const runtime::ErrorCounters& errors = can.counters(node);
    text += line("controller", state_text(errors.state()));
    text += line("error counters", fmt::format("transmit {}, receive {}", errors.transmit, errors.receive));
    if (canopen != nullptr && canopen->canopen() != nullptr)
      text += line("node", runtime::canopen::state_text(static_cast<uint8_t>(canopen->canopen()->state())));
    if (const auto found = heard_.find(&can); found != heard_.end())
      text +=
          line("frames", fmt::format("sent {}, from others {}", found->second.sent, found->second.received));
  }
  return text.empty() ? line("SBus", "not connected") : text;
}

// The numbers are those of MOVIDRIVE and of MOVITRAC 31; a unit has the one or the other.
std::string DiagPages::fieldbus() const {
  std::string text;
  for (const char* number : {"091", "092", "093", "571", "572", "819", "831"}) text += row(number);
  const runtime::ProfibusUse& use = station_.config().profibus;
  runtime::ProfibusPort* port = station_.profibus();
  if (port == nullptr || use.option == nullptr) return text + line("fieldbus card", "none");
  text += line("fieldbus card", fmt::format("{} on {}", use.option->model, use.bus.bus));
  text += dp_lines(port->card().station(), plant_.now());
  const uint8_t address = port->card().station().slave().address();
  for (runtime::ProfibusControl* master : plant_.all<runtime::ProfibusControl>())
    if (const auto* view = master->view(address); view != nullptr && master->settings().bus == use.bus.bus)
      text += line("as " + master->name() + " sees it", profibus::describe(*view));
  const profibus::LedPattern lights = port->card().leds(plant_.now());
  text += line("RUN", light_text(lights.green));
  return text + line("BUS FAULT", light_text(lights.red));
}

std::string DiagPages::gateway(runtime::Gateway& gateway, runtime::Time now) {
  std::string text = fmt::format("{}: gateway from {} to {}\n", gateway.name(), gateway.profibus().bus.bus,
                                 gateway.config().sbus);
  text += dp_lines(gateway.dp(), now);
  for (const runtime::Gateway::Drive& drive : gateway.drives()) {
    text += fmt::format("SBus address {}\n", drive.address);
    text += line("drive", drive.lost ? "does not answer" : "answers");
    text += line("telegrams", fmt::format("sent {}, answered {}, lost {} times", drive.answers.asked,
                                          drive.answers.answered, drive.losses));
    text += line("PO",
                 fmt::format("{:04X} {:04X} {:04X} hex", drive.output[0], drive.output[1], drive.output[2]));
    const auto& input = drive.answers.input;
    text += line("PI", fmt::format("{:04X} {:04X} {:04X} hex", input[0], input[1], input[2]));
  }
  const runtime::ParameterTelegram& last = gateway.channel().last();
  if (last.management != 0)
    text += line("last parameter service",
                 fmt::format("drive {}, index {}: {}", last.subindex, last.index,
                             last.failed() ? runtime::describe(last.return_code())
                                           : fmt::format("{}", static_cast<int32_t>(last.data))));
  return text;
}

std::string DiagPages::page(const std::string& page) {
  std::string text = fmt::format("{}: {}\n", station_.config().name, page);
  if (page == "parameters") return text + parameters();
  if (page == "pd") return text + process_data();
  if (page == "rs485") return text + rs485();
  return text + (page == "can" ? can() : fieldbus());
}

}  // namespace ipos::tools
