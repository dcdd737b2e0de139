// Each kind of line has its own words; here they are together.
#include "runtime/bus/words/bus_words.hpp"

#include <utility>

#include "runtime/bus/movilink/describe_serial.hpp"

namespace ipos::runtime {

namespace {

constexpr size_t kDpLines = 100;  // a log of more names is noise: those after are heard as one (ours)

}  // namespace

BusWords::BusWords(BusNames names)
    : can_(std::move(names.can)), serial_(std::move(names.serial)), dp_(std::move(names.dp)) {}

void BusWords::use(BusNames names) {
  can_.use(std::move(names.can));
  serial_ = std::move(names.serial);
  dp_ = std::move(names.dp);
  for (auto& [line, words] : dp_lines_) words.use(slaves_of(line));
}

std::string BusWords::describe(const Reception& reception) const {
  return runtime::describe(serial_, reception);
}

const std::vector<DpSlaveNames>& BusWords::slaves_of(std::string_view line) const {
  static const std::vector<DpSlaveNames> kNobody;
  if (const auto known = dp_.lines.find(std::string(line)); known != dp_.lines.end()) return known->second;
  return dp_.lines.size() == 1 ? dp_.lines.begin()->second : kNobody;
}

DpLineWords& BusWords::listened(std::string_view line) {
  if (const auto found = dp_lines_.find(line); found != dp_lines_.end()) return found->second;
  const std::string name(dp_lines_.size() < kDpLines ? line : std::string_view());
  return dp_lines_.emplace(name, DpLineWords(slaves_of(line))).first->second;
}

}  // namespace ipos::runtime
