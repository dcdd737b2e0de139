// Volatile writes with their old values, and a file of JSON beside.
#include "tools/serve/borrowed_values.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "stdlib/parameters.hpp"
#include "tools/parameters/parameter_set.hpp"
#include "tools/serve/host/arguments.hpp"
#include "tools/serve/host/parameter_rows.hpp"
#include "tools/serve/state_folder.hpp"

namespace ipos::tools::serve {

using stdlib::Service;

BorrowedValues::BorrowedValues(ParameterAccess& access, const std::string& port, uint8_t address)
    : access_(access),
      port_(port),
      address_(address),
      file_(state_name("borrowed", fmt::format("{} {}", port, address))) {
  const auto text = read_state(file_);
  if (!text) return;
  const Json record = Json::parse(*text, nullptr, false);
  if (!record.is_object() || record.value("unit", "") != access_.unit().name || !record["values"].is_array())
    return;
  for (const Json& row : record["values"]) {
    if (!row.is_array() || row.size() != 3 ||
        !std::all_of(row.begin(), row.end(), [](const Json& number) { return number.is_number_integer(); }))
      continue;
    const Value value{row[0].get<uint16_t>(), row[1].get<int32_t>(), row[2].get<int32_t>(), false, ""};
    // What somebody has set since, or a restart of the drive, counts.
    const AccessReply now = access_.execute(Service::Read, value.index, 0);
    if (!now ? !now.error().code : *now == value.during) values_.push_back(value);
  }
  write_down();
}

int32_t BorrowedValues::read(uint16_t index) {
  const AccessReply now = access_.execute(Service::Read, index, 0);
  if (!now) throw Mistake(why(stdlib::parameter_table(access_.unit()), Service::Read, index, 0, now.error()));
  return *now;
}

// Written down first: a write whose answer is lost may have been carried out.
void BorrowedValues::set(uint16_t index, int32_t value) {
  const std::vector<Value> before = values_;
  const auto known =
      std::find_if(values_.begin(), values_.end(), [&](const Value& one) { return one.index == index; });
  if (known == values_.end())
    values_.push_back({index, read(index), value, false, ""});
  else
    known->during = value;
  write_down();
  try {
    write_parameter(access_, index, value, true);
  } catch (const Refusal&) {  // nothing has changed
    values_ = before;
    write_down();
    throw;
  }
  if (read(index) != value)
    throw Mistake(fmt::format("the drive has not taken {} of {}", value,
                              stdlib::index_name(stdlib::parameter_table(access_.unit()), index)));
}

// An answer to a write may be a late one to an earlier write of the same parameter, so what counts is what is read.
// The last one first: the sources of control and setpoint before the monitoring.
bool BorrowedValues::give_back() {
  const stdlib::ParameterTable& table = stdlib::parameter_table(access_.unit());
  const size_t had = values_.size();
  for (size_t n = values_.size(); n-- > 0;) {
    Value& value = values_[n];
    const AccessReply written = access_.execute(Service::WriteVolatile, value.index, value.before);
    value.needs_inhibit = !written && written.error().code == stdlib::return_codes::kInhibitRequired;
    if (!written) {
      value.why = why(table, Service::WriteVolatile, value.index, value.before, written.error());
      continue;
    }
    const AccessReply now = access_.execute(Service::Read, value.index);
    if (now && *now == value.before)
      values_.erase(values_.begin() + static_cast<ptrdiff_t>(n));
    else
      value.why =
          now ? "the drive has not taken it back" : why(table, Service::Read, value.index, 0, now.error());
  }
  if (values_.size() != had) write_down();
  return values_.empty();
}

bool BorrowedValues::is_borrowed(uint16_t index) const {
  return std::any_of(values_.begin(), values_.end(), [&](const Value& one) { return one.index == index; });
}

bool BorrowedValues::wait_for_inhibit() const {
  return !values_.empty() &&
         std::all_of(values_.begin(), values_.end(), [](const Value& one) { return one.needs_inhibit; });
}

std::vector<std::string> BorrowedValues::texts() const {
  std::vector<std::string> texts;
  for (const Value& value : values_) texts.push_back(text_of(value));
  return texts;
}

std::string BorrowedValues::text_of(const Value& value) const {
  const stdlib::ParameterTable& table = stdlib::parameter_table(access_.unit());
  const stdlib::Parameter* row = table.find(value.index);
  const auto words = [row](int32_t bits) {
    return row == nullptr ? std::to_string(bits) : stdlib::parameter_text(*row, bits);
  };
  const std::string reason =
      value.needs_inhibit ? "the drive takes it back only under controller inhibit" : value.why;
  return fmt::format("{} is {} in place of {}{}{}", stdlib::index_name(table, value.index),
                     words(value.during), words(value.before), reason.empty() ? "" : ": ", reason);
}

// Where nothing can be written down the values are given back all the same, but not by the next start.
void BorrowedValues::write_down() const {
  if (values_.empty()) return remove_state(file_);
  Json rows = Json::array();
  for (const Value& value : values_) rows.push_back({value.index, value.before, value.during});
  const Json record{
      {"port", port_}, {"address", address_}, {"unit", access_.unit().name}, {"values", std::move(rows)}};
  write_state(file_, record.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace ipos::tools::serve
