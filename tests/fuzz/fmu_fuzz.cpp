// Bytes as an FMU, and as its modelDescription.xml: refused with a text, or a model that finds the variables it has.
#include <string>

#include "runtime/fmi_import/archive.hpp"
#include "runtime/fmi_import/description.hpp"
#include "runtime/fmi_import/fmu_model.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace ipos::fmi_import;  // NOLINT
using namespace ipos::tests;       // NOLINT

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string bytes(text_of(data, size));
  if (const auto archive = Archive::open(bytes)) {
    const auto xml = archive->read("modelDescription.xml", 1'000'000);
    require(xml.has_value() || !xml.error().empty(), "a file is refused with a reason");
  } else {
    require(!archive.error().empty(), "an archive is refused with a reason");
  }
  if (const auto model = read_fmu(bytes)) {
    const auto none = (*model)->find("no such variable", ipos::runtime::MachineVariable::Role::Input);
    require(!none && !none.error().empty(), "a variable that is not there is refused with a reason");
  }
  const auto description = read_description(bytes);
  if (!description) {
    require(!description.error().empty(), "a description is refused with a reason");
    return 0;
  }
  require(description->version == 2 || description->version == 3, "a version is one that ipos knows");
  for (const Variable& variable : description->variables) require(!variable.name.empty(), "a variable has a name");
  return 0;
}
