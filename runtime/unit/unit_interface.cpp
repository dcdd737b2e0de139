// Bridges between the bus's, the drive's and the VM's view of one unit.
#include "runtime/unit/unit_interface.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/movilink/sbus_group_master.hpp"
#include "runtime/drive/indices.hpp"

namespace ipos::runtime {

namespace codes = stdlib::return_codes;

// A byte of told_obstacles_ for each bus.
struct UnitInterface::DataBus {
  PoSource bus;
  uint32_t told_shift;
  static const DataBus sbus, rs485, fieldbus;
};
constexpr UnitInterface::DataBus UnitInterface::DataBus::sbus{PoSource::Sbus, 0};
constexpr UnitInterface::DataBus UnitInterface::DataBus::rs485{PoSource::Rs485, 8};
constexpr UnitInterface::DataBus UnitInterface::DataBus::fieldbus{PoSource::Fieldbus, 16};

UnitInterface::UnitInterface(const stdlib::UnitType& unit, const MachineData& machine, DriveOptions options)
    : parameters_(unit, options),
      memory_(parameters_),
      state_(parameters_, machine),
      serial_{index_of("810"), index_of("811"), index_of("750"), index_of("100")},
      task1_speed_(index_of("938")),
      task2_speed_(index_of("939")) {}

void UnitInterface::power_cycle() {
  memory_.reload();
  parameters_.power_cycle();
  state_.power_cycle();
}

std::optional<std::string> UnitInterface::set_parameter(std::string_view parameter, int32_t value) {
  const stdlib::Parameter* row = parameters_.table().find(parameter);
  if (row == nullptr || row->index == 0)
    return fmt::format("unit {} has no parameter {}", parameters_.unit().name, parameter);
  const ParameterReply reply = parameters_.preset(row->index, value);
  if (reply) return std::nullopt;
  return parameters_.explain(static_cast<uint8_t>(ParameterService::Write), row->index, value, reply.error());
}

uint16_t UnitInterface::index_of(std::string_view number) const {
  const stdlib::Parameter* row = parameters_.table().find(number);
  return row == nullptr ? 0 : row->index;
}

int32_t UnitInterface::value(std::string_view number) const { return parameters_.value(index_of(number)); }

void UnitInterface::find_rates() const {
  rates_for_ = parameters_.changes();
  constexpr int32_t kSharedCommands = 9;
  const int32_t first = parameters_.value(task1_speed_);
  const int32_t second = std::min(parameters_.value(task2_speed_), kSharedCommands - first);
  rates_.commands[0] = static_cast<uint32_t>(first + 1);
  rates_.commands[1] = static_cast<uint32_t>(second + 2);
}

void UnitInterface::connect_program(vm::Machine& machine) {
  memory_.variables().use(machine.variables());
  memory_.program().watch(&machine);
}

void UnitInterface::disconnect_program() {
  memory_.variables().park();
  memory_.program().watch(nullptr);
}

tl::expected<int32_t, ReturnCode> UnitInterface::serve(Time now, const ParameterRequest& request) {
  memory_.set_time(now);
  const auto service = static_cast<uint8_t>(request.service);
  const ParameterReply reply = parameters_.execute(service, request.index, request.value);
  if (!reply) {
    reason_ = parameters_.explain(service, request.index, request.value, reply.error());
    if (reply.error() == codes::kProtected) reason_ += " (a program is running)";
  }
  if (request.subindex != 0 && !has_subindices())
    tell_once(Obstacle::Reserved, 0,
              "byte 1 of the parameter channel is reserved on this unit and should be 0: it is ignored");
  return reply;
}

void UnitInterface::take_output(Time /*now*/, OutputChannel channel, std::span<const uint16_t> words) {
  const bool slave = channel == OutputChannel::Group && follows_sbus_master();
  look_for_obstacles(DataBus::sbus, slave);
  if (!slave) return state_.take_po(PoSource::Sbus, words);
  ProcessWords scaled{};
  std::copy_n(words.begin(), std::min(words.size(), scaled.size()), scaled.begin());
  state_.take_po(PoSource::Sbus, scaled_for_slave(scaled, value("751")));
}

void UnitInterface::take_sbus2(std::span<const uint16_t> words) {
  look_for_obstacles(DataBus::sbus, false);
  state_.take_po(PoSource::Sbus2, words);
}

bool UnitInterface::follows_sbus_master() const {
  return stdlib::follows_sbus_master(state_.settings().setpoint_source);
}

bool UnitInterface::is_slave() const { return is_master_slave(state_.settings()); }

// A slave of master/slave operation has only parameters over its fieldbus card (MDX60B/61B p. 29).
void UnitInterface::take_fieldbus(std::span<const uint16_t> words) {
  if (is_slave())
    return tell_once(
        Obstacle::Slave, DataBus::fieldbus.told_shift,
        "PO data over the fieldbus have no effect: the unit is a slave of master/slave operation (P100)");
  look_for_obstacles(DataBus::fieldbus, false);
  state_.take_po(PoSource::Fieldbus, words);
}

void UnitInterface::show_fieldbus_card(uint8_t address) {
  constexpr int32_t kFieldbusCard = 2, kProfibusDp = 5;  // codes of P072 and P091
  if (unit().has(stdlib::Trait::OwnParameterNumbers)) return parameters_.set_display(index::kM31Address, address);
  parameters_.set_display(index::kOption1, kFieldbusCard);
  parameters_.set_display(index::kFieldbusType, kProfibusDp);
  parameters_.set_display(index::kFieldbusAddress, address);
}

// P876, P101 and P100 (1053 1610 p. 41); P841 of MOVITRAC 31 stands for them.
void UnitInterface::look_for_obstacles(const DataBus& bus, bool slave) {
  uint32_t& looked = looked_for_[static_cast<size_t>(bus.bus)][slave ? 1 : 0];
  const uint32_t settings_now = parameters_.changes() + 1;
  if (std::exchange(looked, settings_now) == settings_now) return;
  constexpr int32_t kOn = 1;
  const Settings& settings = state_.settings();
  const BusSource& wanted = bus_source(bus.bus);
  const int32_t control = stdlib::code(wanted.control), setpoint = stdlib::code(wanted.setpoint);
  if (unit().has(stdlib::Trait::OwnParameterNumbers)) {
    if (settings.control_source != control)
      obstruct(bus, Obstacle::ControlSource, "PO data have no effect", "841", kOn);
    return;
  }
  if (settings.po_enable == 0) obstruct(bus, Obstacle::PoDisabled, "PO data have no effect", "876", kOn);
  if (slave) return;
  if (settings.control_source != control)
    obstruct(bus, Obstacle::ControlSource, "the control word has no effect", "101", control);
  else if (!has_control_word())
    tell_once(Obstacle::NoControlWord, bus.told_shift,
              "no PO word is a control word (P870..P872): the drive is enabled as if the bus had sent it");
  if (settings.setpoint_source != setpoint)
    obstruct(bus, Obstacle::SetpointSource, "the setpoints have no effect", "100", setpoint);
}

void UnitInterface::obstruct(const DataBus& bus, Obstacle obstacle, std::string_view what,
                           std::string_view number, int32_t wanted) {
  if (was_told(obstacle, bus.told_shift)) return;
  const stdlib::Parameter* row = parameters_.table().find(number);
  if (row == nullptr) return;
  tell_once(obstacle, bus.told_shift,
            fmt::format("{}: P{} {} is {}, not {}", what, number, row->name,
                        stdlib::parameter_text(*row, value(number)), stdlib::parameter_text(*row, wanted)));
}

void UnitInterface::tell_once(Obstacle obstacle, uint32_t shift, std::string_view text) {
  if (was_told(obstacle, shift)) return;
  told_obstacles_ |= told_bit(obstacle, shift);
  obstacles_.emplace_back(text);
}

bool UnitInterface::has_po_word(std::initializer_list<PoAssignment> wanted) const {
  for (uint32_t n = 0; n < kProcessWords; ++n) {
    const int32_t word = parameters_.value(static_cast<uint16_t>(index::kPo1Description + n));
    if (std::find(wanted.begin(), wanted.end(), static_cast<PoAssignment>(word)) != wanted.end()) return true;
  }
  return false;
}

// Some time after the telegram that is answered.
ProcessWords UnitInterface::input(Time /*now*/) { return state_.pi(); }

bool UnitInterface::follows_sync() const { return state().settings().external_synchronization == 1; }

void UnitInterface::synchronize(Time /*now*/) { ++syncs_; }

SerialParameters UnitInterface::serial_parameters() const {
  return {static_cast<uint8_t>(parameters_.value(serial_.address)),
          static_cast<uint8_t>(parameters_.value(serial_.group)), parameters_.value(serial_.slave_setpoint),
          parameters_.value(serial_.setpoint_source)};
}

void UnitInterface::Rs485Data::take_output(Time /*now*/, OutputChannel /*channel*/,
                                         std::span<const uint16_t> words) {
  drive_.look_for_obstacles(DataBus::rs485, false);
  // The monitoring is restarted by cyclic_request().
  drive_.state_.take_po(PoSource::Rs485, words, false);
}

ProcessWords UnitInterface::Rs485Data::input(Time now) { return drive_.input(now); }

void UnitInterface::Rs485Data::cyclic_request(Time /*now*/) { drive_.state_.take_request(PoSource::Rs485); }

ProcessWords UnitInterface::setpoint_to_send(Time /*now*/) {
  return state_.master_words(slave_setpoint(parameters_.value(serial_.slave_setpoint)));
}

void UnitInterface::setpoint_received(Time /*now*/, const ProcessWords& words) {
  state_.take_po(PoSource::Rs485, scaled_for_slave(words, value("751")));
}

void UnitInterface::link_lost(Time /*now*/) {
  constexpr uint8_t kRs485Timeout = 43;
  state_.raise_fault(kRs485Timeout, FaultResponse::EmergencyError);  // whatever P833 says (MDX60B/61B p. 30)
}

}  // namespace ipos::runtime
