// The files, the description, and which variable is what.
#include "runtime/fmi_import/fmu_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "runtime/fmi_import/archive.hpp"
#include "runtime/fmi_import/description.hpp"
#include "runtime/fmi_import/host_process.hpp"
#include "runtime/signals/physical_units.hpp"

namespace ipos::fmi_import {
namespace {

using runtime::MachineVariable;
using Role = MachineVariable::Role;

#if defined(__aarch64__)
constexpr std::string_view kFolders[] = {"binaries/aarch64-linux/", "binaries/aarch64-linux/"};
#else
constexpr std::string_view kFolders[] = {"binaries/linux64/", "binaries/x86_64-linux/"};  // FMI 2.0, 3.0
#endif

struct RoleWords {
  std::string_view one;
  std::string_view many;
};
constexpr RoleWords kRoles[] = {{"an input", "inputs"}, {"an output", "outputs"}, {"a parameter", "parameters"}};

// Outputs are all that can be looked at, as tools do; what is set has to be an input or a parameter that may be set.
bool plays(const Variable& variable, Role role) {
  switch (role) {
    case Role::Input: return variable.causality == "input";
    case Role::Output: return variable.causality == "output" || variable.causality == "local";
    case Role::Parameter: break;
  }
  return (variable.causality == "parameter" || variable.causality == "structuralParameter") && variable.variability != "constant";
}

template <typename Row>
void append(std::string& bytes, const Row& row) {
  bytes.append(reinterpret_cast<const char*>(&row), sizeof row);
}

class FmuModel final : public runtime::MachineModel, public std::enable_shared_from_this<FmuModel> {
 public:
  FmuModel(Archive archive, Description description) : archive_(std::move(archive)), description_(std::move(description)) {}

  tl::expected<MachineVariable, std::string> find(std::string_view name, Role role) const override;
  std::unique_ptr<runtime::MachineRun> make(Wiring wiring) const override;
  bool gives_state() const override { return description_.gives_state; }
  std::string remark(int64_t step) const override;

  std::string library() const {
    return fmt::format("{}{}.so", kFolders[description_.version - 2], description_.identifier);
  }
  const Archive& archive() const { return archive_; }

 private:
  std::string known(Role role) const;
  Beginning beginning(const Wiring& wiring, const std::filesystem::path& folder) const;

  Archive archive_;
  Description description_;
};

std::string FmuModel::known(Role role) const {
  constexpr size_t kMost = 30;  // ours
  std::vector<std::string_view> names;
  size_t more = 0;
  for (const Variable& variable : description_.variables) {
    if (!plays(variable, role) || !variable.type || (role == Role::Output && variable.causality == "local")) continue;
    if (names.size() < kMost)
      names.push_back(variable.name);
    else
      ++more;
  }
  if (names.empty()) return fmt::format("no {}", kRoles[static_cast<size_t>(role)].many);
  return fmt::format("the {} {}{}", kRoles[static_cast<size_t>(role)].many, fmt::join(names, ", "),
                     more == 0 ? "" : fmt::format(" and {} more", more));
}

tl::expected<MachineVariable, std::string> FmuModel::find(std::string_view name, Role role) const {
  const RoleWords& words = kRoles[static_cast<size_t>(role)];
  const auto& all = description_.variables;
  const auto found = std::find_if(all.begin(), all.end(), [name](const Variable& one) { return one.name == name; });
  if (found == all.end()) return tl::unexpected(fmt::format("the FMU has no variable '{}'; it has {}", name, known(role)));
  if (!plays(*found, role))
    return tl::unexpected(fmt::format("'{}' is no {} of the FMU but {}; it has {}", name, words.one.substr(words.one.find(' ') + 1),
                                      found->causality, known(role)));
  if (!found->type) return tl::unexpected(fmt::format("'{}' is no number", name));
  if (found->is_array) return tl::unexpected(fmt::format("'{}' is an array, which ipos does not wire", name));
  MachineVariable variable{static_cast<uint32_t>(found - all.begin()), *found->type > IPOS_FMU_FLOAT32, {}};
  if (found->unit.empty()) return variable;
  if (const auto unit = description_.units.find(found->unit); unit != description_.units.end() && unit->second)
    variable.unit = *unit->second;
  else if (const auto* by_name = signals::find_physical_unit(found->unit))
    variable.unit = *by_name;
  else
    return tl::unexpected(fmt::format("the unit of '{}' has no base unit, so nothing can be converted into it", name));
  return variable;
}

std::unique_ptr<runtime::MachineRun> FmuModel::make(Wiring wiring) const {
  const auto self = shared_from_this();
  const int64_t limit = wiring.limit;
  const auto unpack = [self](const std::filesystem::path& folder) -> runtime::MachineRun::Done {
    const std::string library = self->library();
    if (const auto done = self->archive_.unpack(library.substr(0, library.rfind('/') + 1), folder); !done) return done;
    return self->archive_.unpack("resources/", folder);
  };
  return std::make_unique<HostProcess>(
      unpack, [self, wiring = std::move(wiring)](const std::filesystem::path& folder) { return self->beginning(wiring, folder); },
      limit);
}

Beginning FmuModel::beginning(const Wiring& wiring, const std::filesystem::path& folder) const {
  const auto row = [this](uint32_t number, double value) {
    const Variable& variable = description_.variables[number];
    return ipos_fmu_variable{variable.reference, static_cast<uint32_t>(*variable.type), value};
  };
  Beginning begin;
  begin.outputs = static_cast<uint32_t>(wiring.outputs.size());
  append(begin.bytes, ipos_fmu_begin{description_.version, static_cast<uint32_t>(wiring.parameters.size()),
                                     static_cast<uint32_t>(wiring.inputs.size()), begin.outputs,
                                     static_cast<uint32_t>(wiring.limit / 1'000'000'000 + 1)});
  for (const runtime::MachineParameter& parameter : wiring.parameters) append(begin.bytes, row(parameter.number, parameter.value));
  for (const uint32_t number : wiring.inputs) append(begin.bytes, row(number, 0));
  for (const uint32_t number : wiring.outputs) append(begin.bytes, row(number, 0));
  // A URI in FMI 2.0 (section 2.1.5), a path with a separator at its end in FMI 3.0 (section 2.3.1). The folder's name has no
  // letter that a URI would write otherwise.
  const std::string resources = (folder / "resources").string();
  for (const std::string& text : {(folder / library()).string(), wiring.name, description_.token,
                                  description_.version == 2 ? "file://" + resources : resources + "/"})
    begin.bytes.append(text.c_str(), text.size() + 1);
  return begin;
}

std::string FmuModel::remark(int64_t step) const {
  const double fixed = description_.fixed_step;
  const double steps = fixed > 0 ? static_cast<double>(step) * 1e-9 / fixed : 1;
  if (std::abs(steps - std::round(steps)) > 1e-6 || steps < 0.5)
    return fmt::format("its FMU steps by {:.9g} s inside, of which {} ms is no multiple", fixed, step / 1'000'000);
  return "";
}

}  // namespace

tl::expected<std::shared_ptr<const runtime::MachineModel>, std::string> read_fmu(std::string bytes) {
  auto archive = Archive::open(std::move(bytes));
  if (!archive) return tl::unexpected(archive.error());
  const auto xml = archive->read("modelDescription.xml", Description::kMostBytes);
  if (!xml) return tl::unexpected(xml.error());
  auto description = read_description(*xml);
  if (!description) return tl::unexpected("its " + description.error());
  auto model = std::make_shared<FmuModel>(*std::move(archive), *std::move(description));
  if (!model->archive().has(model->library()))
    return tl::unexpected(fmt::format("has no {}: it was not made for this system", model->library()));
  return model;
}

}  // namespace ipos::fmi_import
