// `ipos bus` as a user meets it: exit codes, located messages, and that its parts fit together.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/harness/contains.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/profibus/gsd_reader.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

std::string example(const std::string& name) { return project("examples/" + name).string(); }

TEST(Bus, UsageAndHelp) {
  EXPECT_EQ(run_ipos({"bus"}).exit_code, 64);
  EXPECT_EQ(run_ipos({"bus", "frob"}).exit_code, 64);
  EXPECT_EQ(run_ipos({"bus", "load", "x.log"}).exit_code, 64);  // needs --baud
  EXPECT_EQ(run_ipos({"bus", "plan", "x.toml", "--trial", "soon"}).exit_code, 64);
  const CommandResult no_distance = run_ipos({"bus", "plan", "x.toml", "--acyclic", "0ms"});
  EXPECT_EQ(no_distance.exit_code, 64);
  EXPECT_TRUE(contains(no_distance.err, "'0ms' is no time above 0")) << no_distance.err;
  EXPECT_EQ(run_ipos({"bus", "replay", "a", "b", "--id", "xyz"}).exit_code, 64);
  for (const std::string verb : {"plan", "decode", "monitor", "load", "replay", "dbc", "dissector"}) {
    const CommandResult help = run_ipos({"bus", verb, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_TRUE(contains(help.out, "Example")) << verb;
  }
  EXPECT_EQ(run_ipos({"bus", "decode", "/nowhere/a.log"}).exit_code, 66);
  EXPECT_EQ(run_ipos({"bus", "plan", "/nowhere/a.toml"}).exit_code, 66);
  EXPECT_EQ(run_ipos({"bus", "dbc", example("scom/scom.toml"), "-o", "/nowhere/a.dbc"}).exit_code, 74);
}

TEST(Bus, PlanOfTheExamplesHasNoErrors) {
  for (const char* name :
       {"scom/scom.toml", "scom-intel/scom-intel.toml", "movilink/movilink.toml", "sbus-line/line.toml"}) {
    const CommandResult result = run_ipos({"bus", "plan", example(name), "--format", "json"});
    EXPECT_EQ(result.exit_code, 0) << name << result.out;
    const auto plan = nlohmann::json::parse(result.out);
    EXPECT_EQ(plan["lines"].size(), 1U);
    for (const auto& finding : plan["findings"]) EXPECT_EQ(finding["weight"], "hint") << finding;
  }
  EXPECT_EQ(run_ipos({"bus", "plan", example("scom/SCOM1.IPC")}).exit_code, 0);  // a single program
  const CommandResult timed = run_ipos(
      {"bus", "plan", example("scom/scom.toml"), "--format", "json", "--trial", "20ms", "--acyclic", "1us"});
  EXPECT_EQ(nlohmann::json::parse(timed.out)["trial_ns"], 20'000'000);
  EXPECT_EQ(nlohmann::json::parse(timed.out)["acyclic_ns"], 1000);
}

TEST(Bus, PlanWithAnErrorIsExitCode1) {
  const TemporaryFolder folder;
  folder.write("p.toml",
               "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nlength = 81\n[[station]]\nname = \"a\"\nunit = "
               "\"md60a\"\nsbus = "
               "\"sbus\"\n");
  const CommandResult result = run_ipos({"bus", "plan", "p.toml"}, folder.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "sbus: error: 81 m of cable, at 500 kbaud at most 80 m [B06]\n");
}

TEST(Bus, RunDecodeLoadAndReplayFitTogether) {
  const TemporaryFolder folder;
  const std::string plant = example("sbus-line/line.toml");
  ASSERT_EQ(run_ipos({"run", plant, "--for", "1s", "--log", "a.log"}, folder.path()).exit_code, 0);
  const CommandResult decoded = run_ipos({"bus", "decode", "a.log", "--names", plant}, folder.path());
  EXPECT_EQ(decoded.exit_code, 0);
  EXPECT_EQ(decoded.err, "");
  EXPECT_TRUE(contains(decoded.out, " sbus 000 sync telegram\n"));
  EXPECT_TRUE(contains(
      decoded.out, " sbus 10D PO-sync CTRL. WORD 1 0006h (enable), SPEED 1000.0 rpm, 0000h -> inverter1\n"));
  EXPECT_TRUE(contains(decoded.out, " sbus 400 lLength = 12346 (0000303Ah) <- inverter1\n"));
  // The load agrees with what the line itself counted in the run.
  const auto report =
      nlohmann::json::parse(run_ipos({"run", plant, "--for", "1s", "--format", "json"}, folder.path()).out);
  const auto load = nlohmann::json::parse(
      run_ipos({"bus", "load", "a.log", "--baud", "500000", "--format", "json"}, folder.path()).out);
  EXPECT_EQ(load["all"]["frames"], report["buses"][0]["frames"]);
  EXPECT_NEAR(load["all"]["exact_percent"].get<double>(), report["buses"][0]["load_percent"].get<double>(),
              0.1);
  // The object of inverter 1 from the log, to inverter 2 alone.
  folder.write("two.toml",
               "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[station]]\nname = \"inverter2\"\nunit = "
               "\"md60a\"\nprogram = "
               "\"LINE2.IPC\"\nsbus = \"sbus\"\n");
  folder.write("LINE2.IPC", read_text(project("examples/sbus-line/LINE2.IPC")));
  const CommandResult replay =
      run_ipos({"bus", "replay", "a.log", "two.toml", "--id", "400", "--at", "50ms", "--watch=lLength"},
               folder.path());
  EXPECT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_TRUE(contains(replay.out, "lLength  12346")) << replay.out;
  EXPECT_TRUE(contains(replay.out, "50 of 50 frames replayed on sbus\n")) << replay.out;
}

// The example of page 55 of 11264926, in words of a plant and without one.
TEST(Bus, ALogOfCanopen) {
  const TemporaryFolder folder;
  folder.write("a.log",
               "(1000000000.000000) can0 605#4000180200000000\n"
               "(1000000000.001000) can0 585#4F00180201000000\n"
               "(1000000000.002000) can0 606#4000180200000000\n");
  folder.write("plant.toml",
               "[[bus]]\nname = \"line\"\nkind = \"can\"\n[[station]]\nname = \"saw\"\nunit = "
               "\"mdxb\"\nsbus = \"line\"\n[station.parameters]\nP880 = 1\nP886 = 5\n");
  const auto expected = [](const std::string& node) {
    return "(1000000000.000000) can0 605 SDO read 1800h:2 TPDO1 transmission type -> " + node +
           "\n(1000000000.001000) can0 585 SDO 1800h:2 TPDO1 transmission type = 1 <- " + node +
           "\n(1000000000.002000) can0 606 SDO read 1800h:2 TPDO1 transmission type -> node 6\n";
  };
  EXPECT_EQ(run_ipos({"bus", "decode", "a.log", "--canopen"}, folder.path()).out, expected("node 5"));
  EXPECT_EQ(run_ipos({"bus", "decode", "a.log", "--plant", "plant.toml"}, folder.path()).out,
            expected("saw"));
  for (const char* station : {"5", "saw"})
    EXPECT_EQ(
        run_ipos({"bus", "monitor", "a.log", "--plant", "plant.toml", "--station", station}, folder.path())
            .out,
        expected("saw").substr(0, expected("saw").find("(1000000000.002000)")));
  const CommandResult six =
      run_ipos({"bus", "monitor", "a.log", "--canopen", "--station", "6"}, folder.path());
  EXPECT_EQ(six.out, "(1000000000.002000) can0 606 SDO read 1800h:2 TPDO1 transmission type -> node 6\n");
  const CommandResult nobody =
      run_ipos({"bus", "monitor", "a.log", "--canopen", "--station", "saw"}, folder.path());
  EXPECT_EQ(nobody.exit_code, 64);
}

TEST(Bus, LoadNamesItsIdentifiers) {
  const TemporaryFolder folder;
  folder.write("a.log",
               "(1000000000.000000) can0 605#4000180200000000\n(1000000000.001000) can0 185#000000000000\n"
               "(1000000001.002000) can0 080#\n");
  const CommandResult nodes =
      run_ipos({"bus", "load", "a.log", "--baud", "500000", "--canopen"}, folder.path());
  for (const char* text : {"  SDO of node 5\n", "  TPDO1 of node 5\n", "  SYNC\n"})
    EXPECT_TRUE(contains(nodes.out, text)) << nodes.out;
  EXPECT_FALSE(contains(run_ipos({"bus", "load", "a.log", "--baud", "500000"}, folder.path()).out, "SYNC"));
  const std::string plant = example("sbus-line/line.toml");
  ASSERT_EQ(run_ipos({"run", plant, "--for", "1s", "--log", "b.log"}, folder.path()).exit_code, 0);
  const CommandResult units =
      run_ipos({"bus", "load", "b.log", "--baud", "500000", "--plant", plant}, folder.path());
  for (const char* text : {" of inverter1\n", " of inverter3\n", "  object of inverter1\n"})
    EXPECT_TRUE(contains(units.out, text)) << units.out;
}

TEST(Bus, TheDataSheetOfAUnit) {
  const TemporaryFolder folder;
  folder.write("plant.toml",
               "[[station]]\nname = \"a\"\nunit = \"mdxb\"\n[[station]]\nname = \"b\"\nunit = \"md60a\"\n");
  const CommandResult eds = run_ipos({"canopen", "eds", "--unit", "mdxb"}, folder.path());
  EXPECT_EQ(eds.exit_code, 0) << eds.err;
  EXPECT_TRUE(contains(eds.out, "[1018sub1]\nParameterName=Vendor-ID\n")) << eds.out;
  EXPECT_EQ(run_ipos({"canopen", "eds", "plant.toml", "a"}, folder.path()).out, eds.out);
  EXPECT_TRUE(contains(run_ipos({"canopen", "eds", "plant.toml", "b"}, folder.path()).err,
                       "unit md60a has no CANopen"));
  EXPECT_TRUE(contains(run_ipos({"canopen", "eds", "plant.toml", "c"}, folder.path()).err,
                       "has no station 'c', only a, b"));
  EXPECT_TRUE(contains(run_ipos({"canopen", "eds", "plant.toml"}, folder.path()).err, "which station"));
  EXPECT_EQ(run_ipos({"canopen", "eds"}, folder.path()).exit_code, 64);
}

// The variable of DPointer has the low-order bytes, which Motorola's order puts behind those of the next variable
// (1053 1610 p. 55 and 57).
TEST(Bus, TheDissectorTakesObjectsApart) {
  const TemporaryFolder folder;
  std::string program = "#include <constb.h>\n", body;
  for (const auto& [number, format] : {std::pair{1024, 6}, {1025, 0x106}, {1026, 3}, {1027, 0x104}}) {
    const std::string n = std::to_string(number);
    program += "SCTRCYCL t" + n + "; long low" + n + ", high" + n + ";\n";
    body += "t" + n + ".ObjectNo = " + n + "; t" + n + ".CycleTime = 10; t" + n +
            ".Format = " + std::to_string(format) + "; t" + n + ".DPointer = numof(low" + n +
            "); _SBusCommDef(SCD_TRCYCL, t" + n + ");\n";
  }
  folder.write("A.IPC", program + "main() {\n" + body + "_SBusCommOn(); while (1) ; }\n");
  folder.write("plant.toml",
               "[[bus]]\nname = 'sbus'\nkind = 'can'\n[[station]]\nname = 'a'\nunit = 'mdxb'\nsbus = 'sbus'\n"
               "program = 'A.IPC'\n");
  const CommandResult lua = run_ipos({"bus", "dissector", "plant.toml", "-o", "-"}, folder.path());
  ASSERT_EQ(lua.exit_code, 0) << lua.err;
  const auto part = [](const char* name, int number, int offset, int size) {
    return "{name = \"" + std::string(name) + std::to_string(number) +
           "\", offset = " + std::to_string(offset) + ", size = " + std::to_string(size) + "}";
  };
  for (const std::string& row :
       {"[1024] = {station = \"a\", little = false, parts = {" + part("low", 1024, 2, 4) + ", " +
            part("high", 1024, 0, 2) + "}}",
        "[1025] = {station = \"a\", little = true, parts = {" + part("low", 1025, 0, 4) + ", " +
            part("high", 1025, 4, 2) + "}}",
        "[1026] = {station = \"a\", little = false, parts = {" + part("low", 1026, 0, 3) + ", }}",
        "[1027] = {station = \"a\", little = true, parts = {" + part("low", 1027, 0, 4) + ", }}"})
    EXPECT_TRUE(contains(lua.out, row)) << row << "\n" << lua.out.substr(lua.out.find("local objects"), 900);
}

// A master finds the device data by the name of the file, so that is the one without -o.
TEST(Bus, TheDeviceDataOfAProfibusCard) {
  PROVES("DP-ID-03");
  const TemporaryFolder folder;
  for (const auto& [card, unit, file] : {std::tuple{"ffp31", "", "SEW_3100.GSD"},
                                         {"size0", "", "SEW_3111.GSD"},
                                         {"dfp", "mdxb", "SEW_6003.GSD"},
                                         {"dfp", "md60a", "SEW_6000.GSD"}}) {
    std::vector<std::string> words{"profibus", "gsd", card};
    if (*unit != '\0') words.insert(words.end(), {"--unit", unit});
    EXPECT_EQ(run_ipos(words, folder.path()).exit_code, 0) << file;
    const std::string text = read_text(folder.path() / file);
    EXPECT_TRUE(text.starts_with("#Profibus_DP")) << file << ": " << text;
    Gsd gsd = read_gsd(text);
    EXPECT_TRUE(gsd.problems.empty()) << file << ": " << gsd.problems.front();
    EXPECT_EQ("SEW_" + gsd.keys["Ident_Number"].substr(2) + ".GSD", file) << "one ident number a file";
    words.insert(words.end(), {"-o", "-"});
    EXPECT_EQ(run_ipos(words, folder.path()).out, text) << file;
    words.back() = "own.gsd";
    EXPECT_EQ(run_ipos(words, folder.path()).exit_code, 0) << file;
    EXPECT_EQ(read_text(folder.path() / "own.gsd"), text) << file;
  }
  const CommandResult wrong = run_ipos({"profibus", "gsd", "dfp21", "--unit", "mdxb"}, folder.path());
  EXPECT_EQ(wrong.exit_code, 64);
  EXPECT_TRUE(contains(wrong.err, "'dfp21' of unit mdxb is no PROFIBUS interface; known are ")) << wrong.err;
}

// MOVITRAC 31 PROFIBUS, 2.1.2: FFP 31A fits MOVITRAC 31B with a service code of component 4 of at least 14, FFP 31C all MOVITRAC 31C of the sizes 1 to 4.
TEST(Bus, WhichProfibusOptionFitsWhere) {
  PROVES("DP-ID-11");
  const TemporaryFolder folder;
  const auto plan = [&](const std::string& option, const std::string& plate) {
    folder.write("plant.toml", "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 500000\n[[station]]\nname = \"inv\"\nunit = \"mc31\"\noption = \"" + option +
                                   "\"\nprofibus = \"dp\"\nprofibus_address = 8\n[station.unit_rating]\n" + plate +
                                   "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\n");
    return run_ipos({"bus", "plan", "plant.toml"}, folder.path());
  };
  struct Row {
    const char* option;
    const char* plate;
    const char* refusal;  // empty: it fits
  };
  for (const Row& row :
       {Row{"ffp31a", "series = \"B\"\nservice_code = 14\n", ""},
        {"ffp31a", "series = \"B\"\nservice_code = 13\n", "inv: FFP 31A wants a service code of component 4 of at least 14"},
        {"ffp31", "series = \"B\"\nservice_code = 13\n", "inv: FFP 31A wants a service code of component 4 of at least 14"},
        {"ffp31a", "series = \"C\"\n", "inv: FFP 31A is for MOVITRAC 31B"},
        {"ffp31c", "series = \"B\"\n", "inv: FFP 31C is for MOVITRAC 31C"},
        {"ffp31c", "size = 0\n", "inv: FFP 31C is for sizes 1 to 4"},
        {"ffp31c", "size = 1\n", ""},
        {"ffp31", "series = \"C\"\nsize = 4\n", ""},
        {"ffp31", "size = 5\n", "inv: FFP 31C is for sizes 1 to 4"},
        {"size0", "size = 0\n", ""},
        {"size0", "size = 2\n", "inv: the built-in interface is that of MOVITRAC 31C size 0"},
        {"ffp31", "", ""}}) {
    const CommandResult result = plan(row.option, row.plate);
    if (*row.refusal == '\0') {
      EXPECT_EQ(result.exit_code, 0) << row.option << ' ' << row.plate << result.err;
    } else {
      EXPECT_TRUE(contains(result.err, std::string("dp: error: ") + row.refusal + " [B27]")) << row.option << ' ' << row.plate << result.err;
    }
  }
  folder.write("other.toml", "[[station]]\nname = \"b\"\nunit = \"mdxb\"\n[station.unit_rating]\nsize = 1\n");
  EXPECT_TRUE(contains(run_ipos({"bus", "plan", "other.toml"}, folder.path()).err,
                       "other.toml:5:8: error: size is on the plate of unit mc31, not of mdxb"));
}

// A hint, in the plan and in the journal; a station that FMS alone asks needs no configuration of DP.
TEST(Bus, WhoWearsOutAMemoryIsTold) {
  const TemporaryFolder folder;
  for (const auto& [save, told] : {std::pair("ON", true), {"OFF", false}}) {
    folder.write("plant.toml",
                 std::string("[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 500000\n[[station]]\nname = \"inv\"\nunit = \"mc31\"\n"
                             "option = \"ffp31\"\nprofibus = \"dp\"\nprofibus_address = 8\n[station.parameters]\nP802 = \"") +
                     save + "\"\n[[control]]\nname = \"panel\"\nkind = \"fms\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\n" +
                     "[[control.slave.request]]\nat = \"1s\"\nevery = \"200ms\"\nwrite = 1025\ndata = \"00 00 09 50\"\n");
    const CommandResult plan = run_ipos({"bus", "plan", "plant.toml"}, folder.path());
    EXPECT_EQ(plan.exit_code, 0) << plan.err;
    EXPECT_EQ(contains(plan.err, "[B30]"), told) << plan.err;
    EXPECT_EQ(contains(plan.err, "panel writes object 1025 of inv every 200 ms"), told) << plan.err;
    const CommandResult run = run_ipos({"run", "plant.toml", "--for", "10ms", "--why"}, folder.path());
    EXPECT_EQ(contains(run.out + run.err, "panel writes object 1025 of inv every 200 ms"), told) << run.out << run.err;
  }
}

TEST(Bus, BadLogLinesAreLocatedAndTheOthersDecoded) {
  const TemporaryFolder folder;
  folder.write("a.log",
               "(0000000001.000000) can0 20B#3100207E00000000\nnonsense\n(0000000002.000000) can0 7D0#1\n");
  const CommandResult result = run_ipos({"bus", "decode", "a.log"}, folder.path());
  EXPECT_EQ(result.exit_code, 65);
  EXPECT_TRUE(contains(result.out, "20B read 8318 Speed -> address 1")) << result.out;
  EXPECT_TRUE(contains(result.err, "a.log:2:1: error: '(' expected\n"));
  EXPECT_TRUE(contains(result.err, "a.log:3:31: error: second hexadecimal digit of a data byte expected\n"))
      << result.err;
  EXPECT_EQ(run_ipos({"bus", "load", "a.log", "--baud", "500000"}, folder.path()).exit_code, 65);
  EXPECT_EQ(run_ipos({"bus", "replay", "a.log", example("scom/scom.toml")}, folder.path()).exit_code, 65);
}

// The printed telegrams of 1053 1610 p. 25 and 35, as they stand there; blanks and small letters make no
// difference.
TEST(Bus, TelegramsOfRs485InHexadecimal) {
  const TemporaryFolder folder;
  folder.write("t.hex",
               "02 01 05 00 06 3A 98 01 F4 57\n\n1d 01 05 00 07 3a 98 01 f4 49\n02018600000000000000000085\n"
               "02 01 05 00 06 3A 98 01 F4 58\n02 01 86 37 00 21 17 00 00 00 00 84\n"
               "1D 01 86 37 00 21 17 00 00 04 FD 62\n");
  const CommandResult result = run_ipos({"bus", "decode", "t.hex"}, folder.path());
  EXPECT_EQ(
      result.out,
      "3PD cyclic, PO 0006h, 3A98h, 01F4h -> address 1\n"
      "3PD cyclic, PI 0007h, 3A98h, 01F4h <- address 1\n"
      "void, character delay exceeded: 02 01 86 00 00 00 00 00 00 00 00 00 85\n"
      "void, BCC incorrect: 02 01 05 00 06 3A 98 01 F4 58\n"
      "PARAM acyclic, read scale 8471 Ramp t11 DOWN CW -> address 1\n"
      "PARAM acyclic, read scale 8471 Ramp t11 DOWN CW = quantity 4 time, conversion -3 (ms) <- address 1\n")
      << result.err;
  EXPECT_EQ(result.exit_code, 0);
  const CommandResult shown = run_ipos({"bus", "monitor", "t.hex", "--station", "1"}, folder.path());
  EXPECT_EQ(shown.out, result.out);
  EXPECT_TRUE(contains(shown.err, "6 telegrams, 6 shown, 2 void\n")) << shown.err;
  // Of one address the requests are one row of the table, and the answers another.
  const CommandResult table = run_ipos({"bus", "monitor", "t.hex", "--table"}, folder.path());
  EXPECT_TRUE(std::regex_search(table.out, std::regex("-> 1 +2 .*PARAM acyclic, read scale 8471.*\n"
                                                      ".*<- 1 +2 .*PARAM acyclic, read scale 8471.*\n"
                                                      ".*void +2 .*void, BCC incorrect")))
      << table.out;
  // And 2 stands before 10.
  folder.write("order.hex", "02 0A 05 00 06 3A 98 01 F4 5C\n02 02 05 00 06 3A 98 01 F4 54\n");
  const CommandResult order = run_ipos({"bus", "monitor", "order.hex", "--table"}, folder.path());
  EXPECT_TRUE(std::regex_search(order.out, std::regex("-> 2 +1 .*\n.*-> 10 +1 "))) << order.out;
  const CommandResult other = run_ipos({"bus", "monitor", "t.hex", "--station", "2"}, folder.path());
  EXPECT_TRUE(contains(other.err, "6 telegrams, 2 shown, 2 void\n")) << other.err;
  // Located errors; the others are decoded.
  folder.write("bad.hex",
               "02 0G\n02 1\n0.5 1.0 line1 02\n0.000500 0.001000\n02 01 05 00 06 3A 98 01 F4 57 00 00 00 00 "
               "00 00 00 00 "
               "00\n02 01 05 00 06 3A 98 01 F4 57\n");
  const CommandResult bad = run_ipos({"bus", "decode", "bad.hex"}, folder.path());
  EXPECT_EQ(bad.exit_code, 65);
  EXPECT_EQ(bad.err,
            "bad.hex:1:5: error: second hexadecimal digit of a byte expected\n"
            "bad.hex:2:5: error: second hexadecimal digit of a byte expected\n"
            "bad.hex:3:3: error: six digits of microseconds expected\n"
            "bad.hex:4:18: error: blank expected\n"
            "bad.hex:5:55: error: more than 18 bytes, the longest telegram\n"
            "bad.hex: note: 5 lines not understood left out\n");
  EXPECT_EQ(bad.out, "3PD cyclic, PO 0006h, 3A98h, 01F4h -> address 1\n");
}

TEST(Bus, TheSerialLogOfARunIsDecoded) {
  const TemporaryFolder folder;
  const std::string plant = example("movilink-rs485/rs485.toml");
  ASSERT_EQ(run_ipos({"run", plant, "--for", "1s", "--serial-log", "s.log"}, folder.path()).exit_code, 0);
  const std::string log = read_text(folder.path() / "s.log");
  const CommandResult decoded = run_ipos({"bus", "decode", "s.log", "--names", plant}, folder.path());
  EXPECT_EQ(decoded.exit_code, 0);
  EXPECT_EQ(decoded.err, "");
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'),
            std::count(decoded.out.begin(), decoded.out.end(), '\n'));
  EXPECT_TRUE(contains(decoded.out, " line1 PARAM + 3PD cyclic, read 8456 PO2 setpoint")) << decoded.out;
  EXPECT_TRUE(contains(decoded.out, "PO CTRL. WORD 1 0006h (enable), SPEED 1000.0 rpm, 3A98h -> unit2\n"))
      << decoded.out;
  EXPECT_TRUE(
      contains(decoded.out, " line1 PARAM acyclic, write volatile 8470 Ramp t11 UP CW = 2.500 s -> unit2\n"));
  // The begin of the line in the log stands in front.
  EXPECT_EQ(decoded.out.substr(0, decoded.out.find(' ')), log.substr(0, log.find(' ')));
  const CommandResult shown = run_ipos(
      {"bus", "monitor", "s.log", "--plant", plant, "--station", "unit2", "--count", "3"}, folder.path());
  EXPECT_TRUE(contains(shown.out, " line1 PARAM + 3PD cyclic, read 8456 ")) << shown.out << shown.err;
  // A void telegram keeps the reason that its bytes do not show.
  folder.write("void.log", "2.000000 2.005729 line1 1D 01 05 00 00 | void: parity error\n");
  EXPECT_EQ(run_ipos({"bus", "decode", "void.log"}, folder.path()).out,
            "2.000000 line1 void, parity error: 1D 01 05 00 00\n");
}

TEST(Bus, PlanOfAPlantWithSerialLinesOnly) {
  const std::string plant = example("movilink-rs485/rs485.toml");
  const CommandResult text = run_ipos({"bus", "plan", plant, "--trial", "1s"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_EQ(text.err, "") << "both commands were reached";
  EXPECT_TRUE(
      text.out.starts_with("line1: RS-485, 9600 baud, 2 stations, cable up to 200 m\n\n"
                           "  unit1         X13  address 0, group 100\n"
                           "  unit2         X13  address 1, group 100\n"))
      << text.out;
  const auto plan = nlohmann::json::parse(run_ipos({"bus", "plan", plant, "--format", "json"}).out);
  ASSERT_EQ(plan["serial_lines"].size(), 1U);
  const auto& telegrams = plan["serial_lines"][0]["telegrams"];
  ASSERT_GE(telegrams.size(), 2U);
  EXPECT_EQ(telegrams[0]["sender"], "unit1");
  EXPECT_EQ(telegrams[0]["format"], "PARAM + 3PD cyclic");
  EXPECT_EQ(telegrams[0]["bytes"], 18);  // 1053 1610 p. 24
  EXPECT_NEAR(telegrams[0]["wire_ns"].get<double>(), 18 * 11 * 1e9 / 9600, 20);
  EXPECT_EQ(telegrams[1]["sender"], "unit2");
  // What is against a rule; the serial line stands before the SBus.
  const TemporaryFolder folder;
  const auto findings = [&](const std::string& toml) {
    folder.write("p.toml", toml);
    folder.write("Serial.IPC", read_text(project("examples/movilink-rs485/Serial.IPC")));
    return run_ipos({"bus", "plan", "p.toml"}, folder.path());
  };
  const std::string line = "[[bus]]\nname = \"line1\"\nkind = \"rs485\"\n";
  const auto unit = [](const std::string& name, const std::string& keys, const std::string& parameters) {
    return "[[station]]\nname = \"" + name + "\"\nunit = \"mdxb\"\n" + keys + "[station.parameters]\n" +
           parameters;
  };
  const std::string x13 = "rs485 = \"line1\"\n";
  CommandResult result = findings(line + unit("a", x13, "") + unit("b", x13, ""));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "error: line1: a and b both have address P810 = 0; their answers collide [B25]\n");
  result = findings(line + unit("a", "program = \"Serial.IPC\"\n" + x13, "") + unit("b", x13, "P810 = 2\n"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.err, "line1: error: a calls address 1, which no station has [B11]\n"))
      << result.err;
  result = findings(line + unit("a", "rs485_xt = \"line1\"\n", ""));
  EXPECT_TRUE(contains(result.err, "line1: error: a has 57600 baud at XT, the line has 9600 baud"))
      << result.err;
  result = findings(line + unit("a", x13 + "keypad = true\n", "P812 = 500\n"));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(contains(result.err, "hint: a: the keypad sends requests all the time")) << result.err;
  EXPECT_TRUE(contains(result.err, "[B26]\n"));
  result = findings(line + "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n" +
                    unit("a", x13 + "sbus = \"sbus\"\n", ""));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "sbus: 500000 baud, 1 stations, cable up to 80 m\n")) << result.out;
}

TEST(Bus, UnknownIdentifiersAreNamedOnceWithTheirPlace) {
  const TemporaryFolder folder;
  folder.write("a.log", "(0000000001.000000) can0 7D0#01\n(0000000002.000000) can0 7D0#02\n");
  const CommandResult result = run_ipos({"bus", "decode", "a.log"}, folder.path());
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "a.log:1:26: note: nothing is known about identifier 7D0h (2000)\n");
}

TEST(Bus, DbcOfAProgram) {
  const CommandResult result = run_ipos({"bus", "dbc", example("scom/SCOM1.IPC")});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(contains(result.out,
                       "BO_ 1024 Object_1024: 8 SCOM1\n SG_ lTrDataLow : 39|32@0- (1,0) "
                       "[-2147483648|2147483647] \"\" Vector__XXX\n SG_ lTrDataHigh : 7|32@0- "))
      << result.out;
}

}  // namespace
}  // namespace ipos::tests
