// The EDS, read by Python's configparser, and compared with what the node answers.
#include "runtime/bus/canopen/eds.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "stdlib/parameters.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/canopen/object_rig.hpp"

namespace ipos::tests {
namespace {

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen((command + " 2>&1").c_str(), "r"), &pclose);
  std::string text;
  std::array<char, 256> part;
  while (fgets(part.data(), part.size(), pipe.get()) != nullptr) text += part.data();
  return text;
}

TEST(CanopenEds, ReadByAnotherParser) {
  PROVES("MDB-TOC-19");
  for (const char* name : {"mdxb", "md60a"}) {
    const stdlib::UnitType& unit = *stdlib::find_unit(name);
    const auto path = std::filesystem::temp_directory_path() / (std::string("ipos_canopen_") + name + ".eds");
    std::ofstream(path) << eds_text(unit);
    size_t parameters = stdlib::parameter_table(unit).by_index().size();
    // 15 objects of communication, 16 of PDOs, 2 of process data.
    EXPECT_EQ(
        output_of("python3 " IPOS_EDS_SCRIPT " " + path.string()),
        std::to_string(parameters + 15 + 16 + 2) + " " + std::to_string(parameters + 27 + 104 + 22) + "\n");
    std::filesystem::remove(path);
  }
}

// Each section [XXXX] or [XXXXsubY] with a DataType is an entry the node has, and the other way round.
TEST(CanopenEds, AgreesWithTheNode) {
  PROVES("MDB-TOC-19");
  ObjectRig rig;
  for (const stdlib::Parameter* parameter : stdlib::parameter_table(mdxb()).by_index())
    rig.unit.parameters[parameter->index] = 0;
  rig.dictionary.set({0x1003, 0}, 5);  // a full list of errors: of an empty one nothing is read
  const std::string text = eds_text(mdxb());
  size_t entries = 0;
  for (size_t at = text.find("\n["); at != std::string::npos; at = text.find("\n[", at + 1)) {
    unsigned index = 0, sub = 0, type = 0;
    if (sscanf(text.c_str() + at, "\n[%4x", &index) != 1 || index < 0x1000) continue;
    const std::string section = text.substr(at, text.find("\n\n", at) - at);
    const size_t type_at = section.find("DataType=0x");
    if (type_at == std::string::npos) continue;
    sscanf(section.c_str() + type_at, "DataType=0x%x", &type);
    sscanf(section.c_str(), "\n[%*4xsub%x]", &sub);
    const auto value = rig.access.read(0, {static_cast<uint16_t>(index), static_cast<uint8_t>(sub)});
    ASSERT_TRUE(value.has_value()) << section;
    if (type == 5) {
      EXPECT_EQ(value->size(), 1U) << section;
    }
    if (type == 6) {
      EXPECT_EQ(value->size(), 2U) << section;
    }
    if (type == 4 || type == 7) {
      EXPECT_EQ(value->size(), 4U) << section;
    }
    const bool writable = section.find("AccessType=rw") != std::string::npos;
    if (index < 0x206C) {
      EXPECT_EQ(!rig.access.refuses(0, {static_cast<uint16_t>(index), static_cast<uint8_t>(sub)}), writable)
          << section;
    }
    ++entries;
  }
  EXPECT_EQ(entries, stdlib::parameter_table(mdxb()).by_index().size() + 27 + 104 + 22);
}

// P000 is shown only and has no limits; P130 can be set from 0 to 2000 s (in ms), its factory setting is 2 s.
TEST(CanopenEds, AccessAndLimitsOfParameters) {
  const std::string text = eds_text(mdxb());
  const auto section_of = [&](const std::string& name) {
    const size_t at = text.find("\n[" + name + "]\n");
    EXPECT_NE(at, std::string::npos) << name;
    return text.substr(at + 1, text.find("\n\n", at) - at);
  };
  const std::string shown = section_of("207E");
  EXPECT_NE(shown.find("\nAccessType=ro\n"), std::string::npos) << shown;
  EXPECT_EQ(shown.find("Limit="), std::string::npos) << shown;
  const std::string set = section_of("2116");
  EXPECT_NE(set.find("\nAccessType=rw\nDefaultValue=2000\nLowLimit=0\nHighLimit=2000000\n"),
            std::string::npos)
      << set;
  for (const stdlib::Parameter* parameter : stdlib::parameter_table(mdxb()).by_index()) {
    char name[5];
    std::snprintf(name, sizeof name, "%04X", unsigned{parameter->index});
    const std::string section = section_of(name);
    EXPECT_NE(section.find(parameter->writable ? "\nAccessType=rw\n" : "\nAccessType=ro\n"),
              std::string::npos)
        << section;
    if (!parameter->writable) {
      EXPECT_EQ(section.find("Limit="), std::string::npos) << section;
    }
  }
}

}  // namespace
}  // namespace ipos::tests
