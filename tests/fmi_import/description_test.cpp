// modelDescription.xml of strangers.
#include "runtime/fmi_import/description.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"

namespace ipos::fmi_import {
namespace {

using tests::contains;

constexpr const char* kCo = "<CoSimulation modelIdentifier=\"m\"/>";

std::string three(const std::string& inside) {
  return "<fmiModelDescription fmiVersion=\"3.0\" modelName=\"m\" instantiationToken=\"t\">" + inside + "</fmiModelDescription>";
}

std::string mistake_of(const std::string& xml) {
  const auto read = read_description(xml);
  return read ? "" : read.error();
}

TEST(FmuDescription, TypesUnitsAndStatesOfBothVersions) {
  for (const char* file : {"spring2", "spring3"}) {
    const auto read = read_description(tests::read_text(fmt::format("{}/{}/modelDescription.xml", IPOS_FMUS, file)));
    ASSERT_TRUE(read) << read.error();
    EXPECT_EQ(read->version, file[6] - '0');
    EXPECT_EQ(read->identifier, "spring");
    EXPECT_EQ(read->token, "{f1e7cb0a-2c55-4a1e-8f0b-spring}");
    EXPECT_TRUE(read->gives_state);
    EXPECT_EQ(read->variables[0].name, "torque");
    EXPECT_EQ(read->variables[0].causality, "input");
    EXPECT_EQ(read->variables[0].type, IPOS_FMU_FLOAT64);
    EXPECT_EQ(read->variables[1].unit, "rad/s");  // of its declared type
    const auto& torque = read->units.find("N.m")->second;
    ASSERT_TRUE(torque);
    EXPECT_EQ(torque->exponents, (std::array<int8_t, 8>{1, 2, -2, 0, 0, 0, 0, 0}));
  }
}

TEST(FmuDescription, AliasesArraysAndTextsOfFmi3) {
  const auto read = read_description(tests::read_text(IPOS_FMUS "/spring3/modelDescription.xml"));
  ASSERT_TRUE(read);
  const auto find = [&](std::string_view name) {
    return *std::find_if(read->variables.begin(), read->variables.end(), [&](const Variable& one) { return one.name == name; });
  };
  EXPECT_EQ(find("position").reference, find("angle").reference);
  EXPECT_TRUE(find("list").is_array);
  EXPECT_FALSE(find("words").type);
  EXPECT_EQ(read->fixed_step, 1e-5);
}

TEST(FmuDescription, WhatIposCannotUseIsRefused) {
  EXPECT_TRUE(contains(mistake_of("<a"), "modelDescription.xml is no XML: "));
  EXPECT_EQ(mistake_of("<a/>"), "modelDescription.xml describes no FMU");
  EXPECT_EQ(mistake_of("<fmiModelDescription fmiVersion=\"1.0\"/>"), "modelDescription.xml is of FMI 1.0; ipos knows 2.0 and 3.0");
  EXPECT_EQ(mistake_of(three("")), "modelDescription.xml has no CoSimulation: ipos steps FMUs that bring their own solver");
  EXPECT_EQ(mistake_of(three("<CoSimulation modelIdentifier=\"../m\"/>")), "modelDescription.xml has a modelIdentifier that is no name of C");
  EXPECT_EQ(mistake_of(three(std::string(kCo) + "<ModelVariables><Float64 name=\"a\"/></ModelVariables>")),
            "modelDescription.xml has a variable without a name or a reference");
  EXPECT_EQ(mistake_of(three(kCo)), "");
}

// A text that would become a thousand times as long, and one that nests for ever.
TEST(FmuDescription, WhatWouldGrowIsRefused) {
  EXPECT_EQ(mistake_of("<!DOCTYPE a [<!ENTITY b \"bbbbbbbbbb\"><!ENTITY c \"&b;&b;&b;\">]>" + three(kCo)),
            "modelDescription.xml has a document type of its own");
  std::string deep;
  for (int n = 0; n < 100; ++n) deep += "<a>";
  EXPECT_EQ(mistake_of(three(deep)), "modelDescription.xml nests too deeply");
}

}  // namespace
}  // namespace ipos::fmi_import
