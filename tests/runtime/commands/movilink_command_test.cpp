// MOVLNK from its structure to its result (1053 1610 p. 47 to 49): what is handed to the bus, who carries it, what an
// answer writes, who waits for whom, and what the unit answers itself.
#include "runtime/commands/movilink_command.hpp"

#include <gtest/gtest.h>

#include "runtime/bus/movilink/return_code.hpp"
#include "tests/runtime/unit/program_rig.hpp"

namespace ipos::runtime {
namespace {

using tests::ProgramRig;

constexpr int32_t kNotSendable = 0x05050000, kNoAnswer = 0x06020000;
constexpr int32_t kSbus = 5, kOwn = 253;
constexpr int32_t kBefore = 777;  // what nobody has written

// A bus that answers when the test says so.
struct Carrier final : MovilinkMaster {
  std::optional<ReturnCode> start(Time now, const MovilinkJob& job) override {
    if (refuses) return *refuses;
    jobs.push_back(job);
    started.push_back(now);
    return std::nullopt;
  }
  void abort() override { ++aborts; }
  std::vector<MovilinkJob> jobs;
  std::vector<Time> started;
  std::optional<ReturnCode> refuses;
  int aborts = 0;
};

// Structures MOVLNK with data MLDATA in the variables of a program; the fields in the order of the manual.
struct MovlnkRig : ProgramRig {
  explicit MovlnkRig(const char* unit_name = "mdxb", const std::string& text = "END\n")
      : ProgramRig(text, unit_name) {
    movilink.connect(MovilinkBus::Sbus, carrier);
  }
  void put(uint32_t variable, int32_t bus, int32_t address, int32_t format, int32_t service, int32_t index,
           int32_t data) {
    set(variable, {bus, address, format, service, index, data, kBefore});
  }
  vm::Answer start(uint32_t variable = 0, int context = 1, Time now = 0) {
    why.clear();
    return movilink.start(now, machine, context, variable, why).answer;
  }
  int32_t result(uint32_t variable = 0) { return h(variable + 6); }
  void answer(const MovilinkResult& result, Time now = 0) {
    movilink.client(MovilinkBus::Sbus).on_exchange_done(now, result);
  }
  Carrier carrier;
  std::string why;
};

// Formats 0 to 6 and the acyclic 128 to 134 (p. 47): parameter channel and 1 to 3 words, words alone, parameter alone.
struct FormatRow {
  int32_t code;
  bool parameter;
  uint32_t words;
};
constexpr FormatRow kFormatRows[] = {{0, true, 1}, {1, false, 1}, {2, true, 2}, {3, false, 2},
                                     {4, true, 3}, {5, false, 3}, {6, true, 0}};

TEST(Movlnk, HandsItsStructureToTheBus) {
  for (const FormatRow& row : kFormatRows)
    for (const int32_t acyclic : {0, 128}) {
      MovlnkRig rig;
      rig.put(100, kSbus, 17, row.code + acyclic, 2, 8470, 200);
      rig.set(200, {1234, kBefore, 11, -22, 33, kBefore, kBefore, kBefore});
      ASSERT_EQ(rig.start(100), vm::Answer::Wait) << row.code;
      ASSERT_EQ(rig.carrier.jobs.size(), 1U);
      const MovilinkJob& job = rig.carrier.jobs[0];
      EXPECT_EQ(job.address, 17);
      EXPECT_EQ(job.format, row.code + acyclic);
      EXPECT_EQ(job.service, 2);
      EXPECT_EQ(job.index, 8470);
      EXPECT_EQ(job.write_value, 1234);
      const int32_t words[] = {11, -22, 33};
      for (uint32_t n = 0; n < 3; ++n) EXPECT_EQ(job.output[n], n < row.words ? words[n] : 0) << row.code;
      EXPECT_EQ(rig.result(100), kBefore) << "not before there is one";
      EXPECT_EQ(rig.why, "");
    }
}

TEST(Movlnk, AnswersWriteWhatTheFormatHas) {
  for (const FormatRow& row : kFormatRows) {
    MovlnkRig rig;
    rig.put(100, kSbus, 17, row.code, 1, 8470, 200);
    rig.set(200, {1, kBefore, 2, 3, 4, kBefore, kBefore, kBefore, kBefore});
    rig.start(100);
    MovilinkResult result;
    if (row.parameter) result.read_value = -5;
    result.words = static_cast<uint8_t>(row.words);
    result.input = {61, -62, 63};
    rig.answer(result);
    EXPECT_EQ(rig.result(100), 0);
    EXPECT_EQ(rig.h(201), row.parameter ? -5 : kBefore) << row.code;
    const int32_t words[] = {61, -62, 63};
    for (uint32_t n = 0; n < 4; ++n)
      EXPECT_EQ(rig.h(205 + n), n < row.words ? words[n] : kBefore) << row.code << ", PI" << n + 1;
  }
}

// Behind an error the data keep their values (p. 49).
TEST(Movlnk, AnErrorWritesItsCodeOnly) {
  MovlnkRig rig;
  rig.put(100, kSbus, 17, 4, 1, 8470, 200);
  rig.set(200, {1, kBefore, 2, 3, 4, kBefore, kBefore, kBefore});
  rig.start(100);
  MovilinkResult result;
  result.result = 0x06020000;
  result.read_value = 5;
  result.words = 3;
  result.reason = "nobody there";
  rig.answer(result);
  EXPECT_EQ(rig.result(100), kNoAnswer);
  for (const size_t n : {201U, 205U, 206U, 207U}) EXPECT_EQ(rig.h(n), kBefore) << n;
  EXPECT_EQ(rig.told(), "MOVLNK to address 17: nobody there");
}

TEST(Movlnk, OtherFormatsAreRefused) {
  for (const int32_t format : {INT32_MIN, -1, 7, 127, 135, 256, INT32_MAX}) {
    MovlnkRig rig;
    rig.put(100, kSbus, 17, format, 1, 8470, 200);
    EXPECT_EQ(rig.start(100), vm::Answer::Done);
    EXPECT_EQ(rig.result(100), kNotSendable) << format;
    EXPECT_EQ(rig.why, "MOVLNK: Format " + std::to_string(format) + " is none of 0..6 and 128..134");
    EXPECT_TRUE(rig.carrier.jobs.empty());
  }
}

// MLDATA has WritePar, ReadPar, PO1 to PO3 and PI1 to PI3; of them a format needs what it uses up to its last PI word.
TEST(Movlnk, TheDataEndWithTheLastVariableAtTheLatest) {
  for (const FormatRow& row : kFormatRows) {
    const int32_t used = row.words == 0 ? 2 : 5 + static_cast<int32_t>(row.words);
    for (const int32_t data : {1024 - used, 1024 - used + 1, 1023, 1024, 1025, -1, INT32_MIN, INT32_MAX}) {
      MovlnkRig rig;
      rig.put(100, kSbus, 17, row.code, 1, 8470, data);
      const vm::HostReply reply = rig.movilink.start(0, rig.machine, 1, 100, rig.why);
      const bool fits = data == 1024 - used;
      EXPECT_EQ(reply.answer, fits ? vm::Answer::Wait : vm::Answer::Fault) << row.code << " at " << data;
      if (!fits) {
        EXPECT_EQ(reply.fault, vm::kFaultIllop);
      }
      EXPECT_EQ(rig.result(100), kBefore);
    }
  }
}

// BusType (p. 47; MOVITRAC 07 chapter 5.1; 8 IPOSplus p. 309): RS-485 no. 1 and 2, SBus, SBus 2 of MOVIDRIVE B.
TEST(Movlnk, TheBusTypeNamesTheBus) {
  struct Row {
    int32_t code;
    MovilinkBus bus;
    std::string_view units;
  };
  const Row rows[] = {{1, MovilinkBus::SerialXt, "md60a compact mdxb"},
                      {2, MovilinkBus::SerialX13, "md60a mc07 mdxb"},
                      {5, MovilinkBus::Sbus, "md60a compact mc07 mdxb"},
                      {8, MovilinkBus::Sbus2, "mdxb"},
                      {6, MovilinkBus::Canopen, "mc07"}};
  for (const char* unit : {"md60a", "compact", "mc07", "mdxb"})
    for (int32_t code = -1; code <= 10; ++code) {
      MovlnkRig rig(unit);
      Carrier carriers[5];
      for (const Row& row : rows) rig.movilink.connect(row.bus, carriers[static_cast<size_t>(row.bus)]);
      rig.put(100, code, 3, 6, 1, 8470, 200);
      const vm::Answer answer = rig.start(100);
      bool known = false;
      for (const Row& row : rows) {
        const bool this_one = row.code == code && row.units.find(unit) != std::string_view::npos;
        known |= this_one;
        EXPECT_EQ(carriers[static_cast<size_t>(row.bus)].jobs.size(), this_one ? 1U : 0U) << unit << code;
        EXPECT_EQ(rig.movilink.partners(row.bus).size(), this_one ? 1U : 0U) << unit << code;
      }
      EXPECT_EQ(answer, known ? vm::Answer::Wait : vm::Answer::Done) << unit << code;
      EXPECT_EQ(rig.result(100), known ? kBefore : kNotSendable) << unit << code;
      EXPECT_EQ(rig.why.empty(), known) << unit << code;
    }
}

TEST(Movlnk, SaysWhichBusesThereAre) {
  const auto why = [](const char* unit, int32_t code) {
    MovlnkRig rig(unit);
    rig.put(100, code, 3, 6, 1, 8470, 200);
    rig.start(100);
    return rig.why;
  };
  EXPECT_NE(why("compact", 2).find("bus type 2 is none of 1, 5, which "), std::string::npos)
      << why("compact", 2);
  EXPECT_NE(why("mc07", 1).find("bus type 1 is none of 2, 5, 6, which "), std::string::npos)
      << why("mc07", 1);
  EXPECT_NE(why("mdxb", 4).find("bus type 4 is none of 1, 2, 5, 8, which "), std::string::npos);
  EXPECT_NE(why("mdxb", 3).find("only answers its master"), std::string::npos) << why("mdxb", 3);
  EXPECT_NE(why("md60a", 3).find("none of 1, 2, 5"), std::string::npos) << why("md60a", 3);
  EXPECT_NE(why("mdxb", 6).find("none of 1, 2, 5, 8"), std::string::npos) << why("mdxb", 6);
}

TEST(Movlnk, ABusThatIsNotConnectedIsNoAnswer) {
  MovlnkRig rig;
  rig.put(100, 8, 3, 6, 1, 8470, 200);
  EXPECT_EQ(rig.start(100), vm::Answer::Done);
  EXPECT_EQ(rig.result(100), kNoAnswer);
  EXPECT_EQ(rig.why, "MOVLNK: the station is not connected to SBus 2 (key sbus2)");
  rig.movilink.disconnect(MovilinkBus::Sbus);
  rig.put(100, kSbus, 3, 6, 1, 8470, 200);
  EXPECT_EQ(rig.start(100), vm::Answer::Done);
  EXPECT_EQ(rig.result(100), kNoAnswer);
  EXPECT_TRUE(rig.carrier.jobs.empty());
}

// The subindex is in bits 16 to 23 of Index; only MOVIDRIVE B has any.
TEST(Movlnk, SubindicesAreOfMovidriveB) {
  for (const char* unit : {"md60a", "compact", "mc07", "mdxb"})
    for (const int32_t format : {1, 6})
      for (const int32_t index : {0xFFFF, 0x10000, 0x5'2116}) {
        MovlnkRig rig(unit);
        rig.put(100, kSbus, 3, format, 1, index, 200);
        const bool sent = format == 1 || index <= 0xFFFF || unit == std::string_view("mdxb");
        EXPECT_EQ(rig.start(100), sent ? vm::Answer::Wait : vm::Answer::Done) << unit << index;
        EXPECT_EQ(rig.result(100), sent ? kBefore : kNotSendable);
        EXPECT_EQ(rig.why.find("no subindices") != std::string::npos, !sent) << rig.why;
      }
}

// The calling task waits until the answer; the structure is read when it is called.
TEST(Movlnk, TheCallingTaskWaits) {
  MovlnkRig rig("mdxb", "MOVLNK H100\nSET H0 = 1\nEND\n");
  rig.put(100, kSbus, 3, 6, 1, 8470, 200);
  rig.run();
  EXPECT_EQ(rig.h(0), 0);
  EXPECT_EQ(rig.machine.task(1).state, vm::TaskState::Waiting);
  rig.answer({});
  rig.run();
  EXPECT_EQ(rig.h(0), 1);
}

// One exchange at a time on a bus, in the order of the calls; on another bus it does not wait.
TEST(Movlnk, ExchangesOfABusComeOneAfterTheOther) {
  MovlnkRig rig;
  Carrier other;
  rig.movilink.connect(MovilinkBus::Sbus2, other);
  for (uint32_t n = 0; n < 3; ++n) {
    rig.put(100 + 10 * n, kSbus, static_cast<int32_t>(n), 6, 1, 8470, static_cast<int32_t>(200 + 10 * n));
    EXPECT_EQ(rig.start(100 + 10 * n, static_cast<int>(n) + 1), vm::Answer::Wait);
  }
  rig.put(150, 8, 9, 6, 1, 8470, 250);
  EXPECT_EQ(rig.start(150, 3), vm::Answer::Wait);
  EXPECT_EQ(other.jobs.size(), 1U);
  for (uint32_t n = 0; n < 3; ++n) {
    ASSERT_EQ(rig.carrier.jobs.size(), n + 1);
    EXPECT_EQ(rig.carrier.jobs[n].address, static_cast<int32_t>(n));
    EXPECT_EQ(rig.carrier.started[n], static_cast<Time>(n) * 5);
    MovilinkResult result;
    result.read_value = static_cast<int32_t>(n) + 50;
    rig.answer(result, static_cast<Time>(n + 1) * 5);
    for (uint32_t k = 0; k < 3; ++k) EXPECT_EQ(rig.result(100 + 10 * k), k <= n ? 0 : kBefore) << n << k;
    EXPECT_EQ(rig.h(201 + 10 * n), static_cast<int32_t>(n) + 50);
  }
  EXPECT_EQ(rig.result(150), kBefore);
  EXPECT_EQ(rig.carrier.jobs.size(), 3U);
  EXPECT_EQ(rig.start(100), vm::Answer::Wait) << "the bus is free again";
  EXPECT_EQ(rig.carrier.jobs.size(), 4U);
}

TEST(Movlnk, WhatTheBusRefusesIsStored) {
  MovlnkRig rig;
  rig.carrier.refuses = return_codes::kWrongManagement;
  rig.put(100, kSbus, 300, 0, 1, 8470, 200);
  EXPECT_EQ(rig.start(100), vm::Answer::Done);
  EXPECT_EQ(rig.result(100), kNotSendable);
  EXPECT_EQ(rig.why, "MOVLNK: address 300, format 0, service 1 cannot be sent over SBus (key sbus)");
  // The bus is free, and what waits behind an exchange is refused in its turn.
  rig.carrier.refuses.reset();
  for (const uint32_t at : {100U, 110U, 120U, 130U}) {
    rig.put(at, kSbus, static_cast<int32_t>(at), 6, 1, 8470, 200);
    EXPECT_EQ(rig.start(at, 2), vm::Answer::Wait);
  }
  rig.carrier.refuses = return_codes::kCommunication;
  rig.answer({});
  EXPECT_EQ(rig.result(100), 0);
  for (const uint32_t at : {110U, 120U, 130U}) EXPECT_EQ(rig.result(at), kNoAnswer) << at;
  rig.carrier.refuses.reset();
  EXPECT_EQ(rig.start(100), vm::Answer::Wait);
  EXPECT_EQ(rig.carrier.jobs.size(), 2U);
}

// Nobody takes the result of a task that was stopped; its exchange ends on the bus, and one that waits is not begun.
TEST(Movlnk, AStoppedTaskTakesNoResult) {
  for (const int gone : {1, 2, 3}) {
    MovlnkRig rig;
    for (int context = 1; context <= 3; ++context) {
      const auto at = static_cast<uint32_t>(90 + 10 * context);
      rig.put(at, kSbus, context, 6, 1, 8470, 200);
      rig.start(at, context);
    }
    const ProgramRig other("END\n");
    rig.movilink.give_up(other.machine, gone == 3 ? 1 : gone + 1);  // a context of another machine
    rig.movilink.give_up(rig.machine, gone);
    std::vector<int32_t> sent;
    for (int n = 0; n < 3; ++n) {
      if (rig.carrier.jobs.size() == sent.size()) break;
      sent.push_back(rig.carrier.jobs.back().address);
      rig.answer({});
    }
    const std::vector<int32_t> want = gone == 2   ? std::vector<int32_t>{1, 3}
                                      : gone == 3 ? std::vector<int32_t>{1, 2}
                                                  : std::vector<int32_t>{1, 2, 3};
    EXPECT_EQ(sent, want) << gone;
    for (int context = 1; context <= 3; ++context)
      EXPECT_EQ(rig.result(static_cast<uint32_t>(90 + 10 * context)), context == gone ? kBefore : 0)
          << gone << ", task " << context;
  }
}

TEST(Movlnk, AStopOfTheProgramEndsAllExchanges) {
  MovlnkRig rig;
  Carrier other;
  rig.movilink.connect(MovilinkBus::SerialXt, other);
  for (const uint32_t at : {100U, 110U}) {
    rig.put(at, kSbus, 1, 6, 1, 8470, 200);
    rig.start(at, 1);
  }
  rig.put(120, 1, 1, 6, 1, 8470, 200);
  rig.start(120, 2);
  rig.movilink.stop();
  EXPECT_EQ(rig.carrier.aborts, 1);
  EXPECT_EQ(other.aborts, 1);
  EXPECT_EQ(rig.start(110, 1), vm::Answer::Wait);
  EXPECT_EQ(rig.carrier.jobs.size(), 2U) << "nothing is before it";
  rig.answer({});
  EXPECT_EQ(rig.result(110), 0);
  EXPECT_EQ(rig.result(100), kBefore);
}

TEST(Movlnk, PartnersAreThoseThatWereCalled) {
  MovlnkRig rig;
  EXPECT_FALSE(rig.movilink.has_called(100));
  const auto call = [&](int32_t address, int32_t format) {
    rig.put(100, kSbus, address, format, 1, 8470, 200);
    rig.start(100);
    rig.answer({});
  };
  call(7, 1);
  call(9, 6);
  call(8, 2);
  EXPECT_TRUE(rig.movilink.has_called(100));
  EXPECT_FALSE(rig.movilink.has_called(101));
  const auto partner = [&](size_t n) { return rig.movilink.partners(MovilinkBus::Sbus).at(n); };
  EXPECT_EQ(rig.movilink.partners(MovilinkBus::Sbus).size(), 3U);
  for (const auto& [n, address, parameter, words] :
       {std::tuple{0, 7, false, true}, {1, 9, true, false}, {2, 8, true, true}}) {
    EXPECT_EQ(partner(static_cast<size_t>(n)).address, address);
    EXPECT_EQ(partner(static_cast<size_t>(n)).parameter, parameter);
    EXPECT_EQ(partner(static_cast<size_t>(n)).process_data, words);
  }
  call(7, 6);
  call(9, 3);
  EXPECT_EQ(rig.movilink.partners(MovilinkBus::Sbus).size(), 3U) << "known already";
  for (size_t n = 0; n < 3; ++n) EXPECT_TRUE(partner(n).parameter && partner(n).process_data) << n;
}

// Address 253 is the unit itself, over no bus (p. 47).
TEST(MovlnkToTheOwnUnit, ReadsAndWritesParameters) {
  MovlnkRig rig("md60a");
  rig.put(100, 99, kOwn, 6, 1, 8470, 200);
  rig.set(200, {2500, kBefore});
  EXPECT_EQ(rig.start(100), vm::Answer::Done);
  EXPECT_EQ(rig.result(100), 0);
  EXPECT_EQ(rig.h(201), 2000) << "P130 from the factory";
  for (const int32_t service : {2, 3}) {
    rig.h(200) += 100;
    rig.put(100, 99, kOwn, 6, service, 8470, 200);
    rig.h(201) = kBefore;
    rig.start(100);
    EXPECT_EQ(rig.result(100), 0);
    EXPECT_EQ(rig.parameter("P130"), rig.h(200));
    EXPECT_EQ(rig.h(201), kBefore) << "a writing service reads nothing";
  }
  EXPECT_EQ(rig.parameters.eeprom_writes(8470), 1U);
  rig.h(200) = 2505;  // off the grid
  rig.put(100, 99, kOwn, 6, 2, 8470, 200);
  rig.start(100);
  EXPECT_EQ(rig.result(100), 0x0800001D);
  EXPECT_EQ(rig.parameter("P130"), 2700);
  EXPECT_TRUE(rig.carrier.jobs.empty());
}

// Service, index and subindex are handed on one by one, with the value that is written.
TEST(MovlnkToTheOwnUnit, HandsTheWholeRequestOn) {
  struct Parameters final : ParameterServer {
    tl::expected<int32_t, ReturnCode> serve(Time now, const ParameterRequest& request) override {
      times.push_back(now);
      requests.push_back(request);
      return 42;
    }
    std::vector<ParameterRequest> requests;
    std::vector<Time> times;
  } parameters;
  MovlnkRig rig;
  MovilinkCommand command(rig.unit, parameters, rig.server, rig.journal, "unit1");
  for (const int32_t index : {0x2116, 0x1'2116, 0x80'FFFF, 0xFF'0001}) {
    rig.put(100, kSbus, kOwn, 6, 1, index, 200);
    rig.set(200, {-9, kBefore});
    EXPECT_EQ(command.start(index, rig.machine, 1, 100, rig.why).answer, vm::Answer::Done);
    EXPECT_EQ(rig.h(201), 42);
    const ParameterRequest& request = parameters.requests.back();
    EXPECT_EQ(request.service, Service::Read);
    EXPECT_EQ(request.index, index & 0xFFFF);
    EXPECT_EQ(request.subindex, index >> 16);
    EXPECT_EQ(request.value, -9);
    EXPECT_EQ(parameters.times.back(), index);
  }
}

TEST(MovlnkToTheOwnUnit, RefusesWhatIsNoService) {
  struct Row {
    int32_t service, index, result;
  };
  for (const Row& row :
       {Row{0, 8470, kNotSendable}, Row{-1, 8470, kNotSendable}, Row{99, 8470, kNotSendable},
        Row{1, -1, kNotSendable}, Row{1, 0x100'0000, kNotSendable}, Row{1, INT32_MIN, kNotSendable},
        Row{1, 0, 0x08000010}, Row{1, 0xFF'2116, 0}, Row{1, 8470, 0}}) {
    MovlnkRig rig;
    rig.put(100, kSbus, kOwn, 0, row.service, row.index, 200);
    rig.set(200, {1, kBefore, 6, kBefore, kBefore, kBefore});
    EXPECT_EQ(rig.start(100), vm::Answer::Done);
    EXPECT_EQ(rig.result(100), row.result) << row.service << ", " << row.index;
    if (row.result != 0) {
      EXPECT_EQ(rig.h(205), kBefore);
      EXPECT_EQ(rig.drive.po()[0], 0) << "no process data behind an error";
    }
  }
}

TEST(MovlnkToTheOwnUnit, ExchangesAsManyWordsAsTheFormatHas) {
  for (const FormatRow& row : kFormatRows) {
    MovlnkRig rig;
    for (const char* number : {"P873", "P874", "P875"}) rig.preset(number, 9);  // IPOS PI-DATA
    rig.drive.set_ipos_pi({0x8001, 2, 0xFFFF});
    rig.put(100, kSbus, kOwn, row.code, 1, 8470, 200);
    rig.set(200, {1, kBefore, 0x1'0006, -2, 3, kBefore, kBefore, kBefore});
    EXPECT_EQ(rig.start(100), vm::Answer::Done);
    EXPECT_EQ(rig.result(100), 0);
    EXPECT_EQ(rig.h(201) != kBefore, row.parameter) << row.code;
    EXPECT_EQ(rig.server.has_reasons(), row.words > 0) << "P101 keeps words away, where any came";
    const uint16_t sent[] = {6, 0xFFFE, 3};
    const int32_t received[] = {0x8001 - 0x10000, 2, -1};
    for (uint32_t n = 0; n < 3; ++n) {
      EXPECT_EQ(rig.drive.po()[n], n < row.words ? sent[n] : 0) << row.code << ", PO" << n + 1;
      EXPECT_EQ(rig.h(205 + n), n < row.words ? received[n] : kBefore) << row.code << ", PI" << n + 1;
    }
  }
}

}  // namespace
}  // namespace ipos::runtime
