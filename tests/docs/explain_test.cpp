// ipos explain, for each kind of code.
#include <gtest/gtest.h>

#include "compiler/diag/diag.hpp"
#include "runtime/bus_plan/plan.hpp"
#include "stdlib/faults.hpp"
#include "stdlib/language_tables.hpp"
#include "tests/tools/command.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tests {
namespace {

std::string explained(const std::string& code) {
  const CommandResult result = run_ipos({"explain", code});
  EXPECT_EQ(result.exit_code, 0) << code << "\n" << result.err;
  return result.out;
}

TEST(Explain, PageOfAMessageWithoutMarksOfMarkdown) {
  const std::string text = explained("e0172");
  EXPECT_TRUE(text.starts_with("E0172: address operator\n\n")) << text;
  EXPECT_NE(text.find("\nWrong:\n\n    long target, p;\n    main() { p = &target; *p = 1; }\n\nRight:\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find('`'), std::string::npos);
  EXPECT_EQ(explained("E0236").find("<!--"), std::string::npos);
}

TEST(Explain, WarningsNameTheirFlag) {
  EXPECT_NE(explained("W0201").find("-Wno-unused-variable"), std::string::npos);
  EXPECT_EQ(explained("E0201").find("-Wno"), std::string::npos);
}

TEST(Explain, RuleOfTheVerifier) {
  const vm::RuleInfo& rule = vm::rule_table()[2];
  EXPECT_EQ(explained(rule.code),
            std::string(rule.code) + ": rule of the verifier\n  " + rule.meaning + "\n");
}

TEST(Explain, ReturnCodesInEveryForm) {
  // 1053 1610 p. 66: error class 8, code 0, additional code 10 hex.
  const std::string text = explained("8/0/10");
  EXPECT_NE(text.find("invalid parameter index"), std::string::npos) << text;
  EXPECT_NE(text.find("class 8: other error"), std::string::npos) << text;
  for (const char* same : {"0x08000010", "0X8000010", "134217744", "08/00/0010"})
    EXPECT_EQ(explained(same), text);
  EXPECT_NE(explained("6/2/0").find("no communication"), std::string::npos);
  EXPECT_NE(explained("8/7/7").find("in no manual"), std::string::npos);
}

TEST(Explain, FaultsOfPrograms) {
  EXPECT_NE(explained("F10").find("division by zero"), std::string::npos);
  EXPECT_NE(explained("f32").find("deeper"), std::string::npos);
}

TEST(Explain, WhatIsNotSimulatedOfAParameter) {
  const std::string mode = explained("P700");
  EXPECT_EQ(mode.find("torque control is not"), std::string::npos) << mode;
  EXPECT_NE(mode.find("\n  not simulated (21): the drive turns with ideal speed control"), std::string::npos);
  EXPECT_NE(explained("P138").find("\n  not simulated: the ramps are not limited\n"), std::string::npos);
  EXPECT_EQ(explained("P130").find("not simulated"), std::string::npos);
}

TEST(Explain, FaultsOfTheDrive) {
  // 1053 1610 p. 41, 64, 81: F47, P815, P836 = EMERG.STOP/ERROR.
  const std::string text = explained("F47");
  EXPECT_TRUE(text.starts_with("F47: fault of the drive, SBus timeout\n")) << text;
  for (const char* part : {"P815", "P836", "EMERG.STOP/ERROR"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  EXPECT_EQ(explained("f047"), text);
  // Each unit in its own words: MOVIDRIVE B has P883, MOVITRAC 31 has P571 and P572 (0922 6818, 3.3).
  EXPECT_NE(text.find("MOVIDRIVE MDX60B/61B: no process data over the SBus within P883"), std::string::npos) << text;
  const std::string fieldbus = explained("F28");
  EXPECT_NE(fieldbus.find("MOVITRAC 31: no process data over PROFIBUS within the fieldbus timeout P571"),
            std::string::npos)
      << fieldbus;
  EXPECT_NE(fieldbus.find("response: P572"), std::string::npos) << fieldbus;
  EXPECT_NE(fieldbus.find("response: P831"), std::string::npos) << fieldbus;
  EXPECT_NE(explained("F01").find("overcurrent"), std::string::npos);
  EXPECT_NE(explained("F1").find("IMM. STOP/ERROR"), std::string::npos);
  const std::string all = explained("F");
  for (const stdlib::FaultRow& row : stdlib::fault_table())
    EXPECT_NE(all.find(std::string(row.name) + ": " + stdlib::meaning_on(*stdlib::find_unit("mdxb"), row)),
              std::string::npos)
        << row.name;
}

TEST(Explain, Parameters) {
  const std::string ramp = explained("p130");
  EXPECT_NE(
      ramp.find(
          "P130 of MOVIDRIVE MD_60A, MOVIDRIVE compact, MOVIDRIVE MDX60B/61B: Ramp t11 UP CW, index 8470"),
      std::string::npos)
      << ramp;
  EXPECT_NE(ramp.find("P130 of MOVITRAC 07, MOVITRAC B: Ramp t11 UP CW, index 8807"), std::string::npos) << ramp;
  EXPECT_NE(ramp.find("factory setting 2.000 s"), std::string::npos) << ramp;
  EXPECT_NE(ramp.find("0.000 s .. 1.000 s in steps of 0.010 s"), std::string::npos) << ramp;
  EXPECT_NE(explained("P101").find("3 = SBus"), std::string::npos);
  EXPECT_NE(explained("P101").find("under controller inhibit"), std::string::npos);
  EXPECT_NE(explained("P000").find("read only"), std::string::npos);
  EXPECT_NE(explained("P932").find("keypad"), std::string::npos);
  EXPECT_EQ(explained("8807"), ramp.substr(ramp.find("P130 of MOVITRAC 07")));
  const std::string address = explained("8600");
  EXPECT_NE(address.find("P813 of MOVIDRIVE MD_60A"), std::string::npos) << address;
  EXPECT_NE(address.find("P881 of MOVIDRIVE MDX60B/61B"), std::string::npos) << address;
}

TEST(Explain, FindingsOfTheBusPlan) {
  for (const runtime::FindingType& row : runtime::finding_types())
    EXPECT_NE(explained(std::string(row.code)).find(std::string(row.meaning)), std::string::npos) << row.code;
}

TEST(Explain, SystemVariablesByEveryName) {
  // IPOSplus p. 29: H454 ModTagPos, MOD.TAGPOS in assembler text.
  const std::string text = explained("H454");
  EXPECT_TRUE(text.starts_with("H454 ModTagPos: ")) << text;
  for (const char* same : {"h454", "ModTagPos", "modtagpos", "MOD.TAGPOS"}) EXPECT_EQ(explained(same), text);
  EXPECT_NE(explained("H474").find("not simulated"), std::string::npos);
}

TEST(Explain, SystemFunctionsWithTheirArguments) {
  // 1053 1610 p. 47 prints it as _Movilink, p. 49 has what Result is.
  const std::string text = explained("_MoviLink");
  for (const char* part :
       {"_MoviLink(s)", "arguments: MOVLNK", "blocks: until the answer", "1053 1610 p. 47"})
    EXPECT_NE(text.find(part), std::string::npos) << part << text;
  EXPECT_EQ(explained("_Movilink"), text);
  for (const stdlib::SystemFunction& row : stdlib::system_functions())
    EXPECT_NE(explained(std::string(row.name)).find("written: "), std::string::npos) << row.name;
}

TEST(Explain, StructuresConstantsAndCommands) {
  // 1053 1610 p. 47: the members in their order, and the values of BusType.
  const std::string data = explained("MLDATA");
  EXPECT_LT(data.find("WritePar"), data.find("ReadPar"));
  EXPECT_LT(data.find("PO3"), data.find("PI1"));
  const std::string link = explained("MOVLNK");  // structure and command
  for (const char* part :
       {"structure of 7 variables", "ML_BT_S0 = 1", "ML_BT_SBUS = 5", "command of the drive"})
    EXPECT_NE(link.find(part), std::string::npos) << part << link;
  EXPECT_NE(explained("ML_BT_SBUS").find("\n  5\n"), std::string::npos);
}

TEST(Explain, OtherWordsAreSearchedFor) {
  const CommandResult ramps = run_ipos({"explain", "ramp", "UP", "ccw"});
  EXPECT_EQ(ramps.exit_code, 0);
  // 1053 1610: P132 and P142 are the ramps up CCW of both sets.
  EXPECT_NE(ramps.out.find("P132"), std::string::npos) << ramps.out;
  EXPECT_NE(ramps.out.find("P142"), std::string::npos) << ramps.out;
  EXPECT_EQ(ramps.out.find("P131"), std::string::npos) << ramps.out;
  EXPECT_NE(explained("overcurrent").find("F01"), std::string::npos);
  EXPECT_NE(explained("ML_FT").find("ML_FT_PAR1"), std::string::npos);
}

TEST(Explain, UnknownCodesAreErrors) {
  for (const char* code : {"E9999", "W", "V99", "F98", "F0", "F300", "Fx", "P", "P999", "P8470", "8/0",
                           "8/0/x", "9/0/0", "0x", "0x100000000", "-1x", "1/1/1/1"}) {
    const CommandResult result = run_ipos({"explain", "--", code});
    EXPECT_EQ(result.exit_code, 65) << code << result.out;
    EXPECT_NE(result.err.find("code"), std::string::npos) << code << result.err;
  }
}

}  // namespace
}  // namespace ipos::tests
