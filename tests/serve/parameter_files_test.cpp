// The tab Parameters beside files: what differs from a file or from a station of a plant file, what is copied, and the lines
// that a plant file takes.
#include "tests/serve/serving.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kTwoDrives =
    "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n"
    "[[station]]\nname = \"belt\"\nunit = \"mdxb\"\nsbus = \"sbus\"\n[station.parameters]\nP130 = \"1.5 s\"\nP600 = \"NO FUNCTION\"\n"
    "P881 = 4\n"
    "[[station]]\nname = \"gate\"\nunit = \"mdxb\"\nsbus = \"sbus\"\n[station.parameters]\nP881 = 5\n";

class OnParameters : public Serving {
 protected:
  OnParameters() : Serving(plant_of(kTwoDrives)) {}

  Json compare(Json with, const char* station = "belt") {
    with["do"] = "parameters.compare";
    with["station"] = station;
    return good(with);
  }
  static Json row(const Json& compared, const char* number) {
    for (const Json& one : compared["rows"])
      if (one["number"] == number) return one;
    return nullptr;
  }
  std::string text_of(const char* station, const char* number) {
    for (const Json reply = good({{"do", "parameters"}, {"station", station}}); const Json& one : reply["parameters"])
      if (one["number"] == number) return one["text"];
    return {};
  }
};

TEST_F(OnParameters, WhatOnlyShowsAValueNamesItsParameter) {
  const Json rows = good({{"do", "parameters"}, {"station", "belt"}})["parameters"];
  const auto named = [&](const char* number) {
    return *std::find_if(rows.begin(), rows.end(), [&](const Json& one) { return one["number"] == number; });
  };
  EXPECT_EQ(named("P031")["shows"], "P600") << named("P031");
  EXPECT_EQ(named("P600")["shows"], nullptr);
  EXPECT_EQ(named("P600")["changed"], true);
  EXPECT_EQ(named("P031")["changed"], false);
  EXPECT_EQ(named("P130")["default"], "2.000 s") << "as delivered (1053 1610 p. 70)";
}

// P130 is 2 s as delivered, and P600 ENABLE/RAPID STOP.
TEST_F(OnParameters, APlantFileIsTheFactorySettingAndWhatItSays) {
  const Json same = compare({{"text", kTwoDrives}});
  EXPECT_EQ(same["rows"], Json::array()) << "the plant file that it was made of";
  const Json other = compare({{"text", "[[station]]\nname = \"belt\"\nunit = \"mdxb\"\n[station.parameters]\nP130 = \"3 s\"\nP881 = 4\n"}});
  ASSERT_EQ(other["rows"].size(), 2U) << other;
  EXPECT_EQ(row(other, "P130")["text"], "1.500 s");
  EXPECT_EQ(row(other, "P130")["with"], "3.000 s");
  EXPECT_EQ(row(other, "P600")["text"], "NO FUNCTION");
  EXPECT_NE(row(other, "P600")["with"], "NO FUNCTION");
  // The only station of this unit is meant whatever it is called; of several one must have the name.
  EXPECT_EQ(compare({{"text", "[[station]]\nname = \"mill\"\nunit = \"mdxb\"\n"}}).value("rows", Json()).size(), 3U);
  EXPECT_EQ(error({{"do", "parameters.compare"}, {"station", "belt"}, {"text", "[[station]]\nname = \"mill\"\nunit = \"mc07\"\n"}}),
            "the plant file has no station of unit mdxb");
  EXPECT_EQ(error({{"do", "parameters.compare"}, {"station", "belt"},
                   {"text", "[[station]]\nname = \"a\"\nunit = \"mdxb\"\n[[station]]\nname = \"b\"\nunit = \"mdxb\"\n"}}),
            "the plant file has no station 'belt', but a, b");
  const std::string neither = error({{"do", "parameters.compare"}, {"station", "belt"}, {"text", "P130 = 2"}});
  EXPECT_EQ(neither.rfind("this is neither a file of ipos param nor a plant file", 0), 0U) << neither;
}

TEST_F(OnParameters, WhatDiffersIsCopiedAtOnce) {
  const Json before = compare({{"with", "gate"}});
  ASSERT_FALSE(row(before, "P130").is_null()) << before;
  EXPECT_EQ(row(before, "P130")["with"], "2.000 s");
  good({{"do", "parameters.load"}, {"station", "belt"}, {"text", before["file"]}});
  EXPECT_EQ(text_of("belt", "P130"), "2.000 s");
  EXPECT_EQ(compare({{"with", "gate"}})["rows"], Json::array());
  // A file of ipos param is compared in the same way.
  const Json file = good({{"do", "parameters.save"}, {"station", "belt"}});
  good({{"do", "parameters.set"}, {"station", "belt"}, {"number", "P131"}, {"value", "7 s"}});
  const Json differs = compare({{"text", file["text"]}});
  ASSERT_EQ(differs["rows"].size(), 1U) << differs;
  EXPECT_EQ(row(differs, "P131")["text"], "7.000 s");
}

// The lines make the same settings again, whatever they are: numbers with units, texts, transferred numbers, indices.
TEST_F(OnParameters, TheLinesForAPlantFileMakeTheSameSettings) {
  for (const auto& [number, value] : {std::pair("P131", "7 s"), {"P302", "1200 rpm"}, {"P601", "NO FUNCTION"}, {"P100", "SBus"},
                                      {"P302", "900"}, {"P941", "EXT.ENC (X14)"}})
    page.ask({{"do", "parameters.set"}, {"station", "belt"}, {"number", number}, {"value", value}});
  const Json reply = good({{"do", "parameters.toml"}, {"station", "belt"}});
  EXPECT_EQ(reply["file"], "belt.toml");
  const std::string text = reply["text"];
  EXPECT_EQ(text.rfind("[station.parameters]\n", 0), 0U);
  EXPECT_NE(text.find("\nP130 = \"1.500 s\"  # Ramp t11 UP CW, factory setting 2.000 s\n"), std::string::npos) << text;
  EXPECT_LT(text.find("P130"), text.find("P600"));
  EXPECT_EQ(text.find("P031"), std::string::npos) << "a display value";
  const std::string made = "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[station]]\nname = \"belt\"\nunit = \"mdxb\"\nsbus = \"sbus\"\n" + text;
  ServedPage other(plant_of(made));
  const Json settings = other.ask({{"do", "parameters.save"}, {"station", "belt"}});
  EXPECT_EQ(settings["text"], good({{"do", "parameters.save"}, {"station", "belt"}})["text"]) << text;
}

// Of every kind of unit, with every setting at another value than the factory's where the unit takes one.
TEST(LinesForAPlant, HoldForEveryUnit) {
  for (const char* unit : {"md60a", "mdxb", "mc07", "mc31"}) {
    const std::string head = std::string("[[station]]\nname = \"one\"\nunit = \"") + unit + "\"\n";
    ServedPage page(plant_of(head));
    page.ask({{"do", "step"}, {"ms", 5}});
    size_t set = 0;
    for (const Json reply = page.ask({{"do", "parameters"}, {"station", "one"}}); const Json& row : reply["parameters"]) {
      if (!row["shows"].is_null() || row["access"] == "R" || row["access"] == "RO") continue;
      if (row["number"] == "P802" || row["number"] == "P803" || row["number"] == "P804") continue;  // lock and factory setting
      std::vector<std::string> tries;
      for (const Json& choice : row["choices"]) tries.push_back(choice);
      if (row["most"].is_string()) tries.push_back(row["most"]);
      for (const std::string& value : tries) {
        if (value == row["text"]) continue;
        const std::string name = row["number"].get<std::string>().empty() ? std::to_string(row["index"].get<int>()) : row["number"].get<std::string>();
        if (page.ask({{"do", "parameters.set"}, {"station", "one"}, {"number", name}, {"value", value}}).value("ok", false)) {
          ++set;
          break;
        }
      }
    }
    EXPECT_GE(set, 5U) << unit;  // seven of a MOVITRAC 31, without P802, and P571 is at its maximum
    const std::string lines = page.ask({{"do", "parameters.toml"}, {"station", "one"}})["text"];
    runtime::PlantFileResult file = runtime::read_plant_file(head + lines);
    EXPECT_TRUE(file.errors.empty()) << unit << ": " << file.errors.front().text << "\n" << lines;
    const Json compared = page.ask({{"do", "parameters.compare"}, {"station", "one"}, {"text", head + lines}});
    EXPECT_EQ(compared["rows"], Json::array()) << unit;
  }
}

}  // namespace
}  // namespace ipos::tests
