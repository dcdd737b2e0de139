// FMS at service level: objects, connections and services against the tables of the manual.
#include "runtime/bus/profibus/fms/server.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "runtime/bus/profibus/card.hpp"
#include "runtime/bus/profibus/fms_objects.hpp"
#include "tests/runtime/bus/profibus/mc31_rig.hpp"

namespace ipos::tests {
namespace {

// A card with an FMS master before it, and DP where a test wants it.
struct FmsBench {
  explicit FmsBench(OptionKind kind = OptionKind::Ffp31)
      : objects(parameters, drive, slave), server(objects, option_type(kind).fms) {}

  fms::Response open(uint8_t cref) {
    return server.initiate(now, cref, 2, master_entry(*fms::find_connection(cref), 8));
  }
  // The answer, however long it takes; `took` says how long.
  fms::Response ask(uint8_t cref, fms::Service service, uint16_t index = 0, const Octets& data = {}) {
    const Time from = now;
    auto response = server.request(now, cref, {service, index, data});
    for (int ms = 0; !response && ms < 2000; ++ms) {
      response = server.response(now, cref);
      if (!response) now += kMillisecond;
    }
    took = now - from;
    return *response;
  }
  std::string read(uint16_t index) {
    const fms::Response response = ask(7, fms::Service::Read, index);
    return response.end == fms::End::Positive ? text_of(response.data) : error(response);
  }
  std::string write(uint16_t index, const std::string& data) { return write(index, hex(data)); }
  std::string write(uint16_t index, const Octets& data) {
    const fms::Response response = ask(7, fms::Service::Write, index, data);
    return response.end == fms::End::Positive ? "+" : error(response);
  }
  static std::string error(const fms::Response& response) {
    if (response.end == fms::End::Rejected) return "Reject";
    if (response.end == fms::End::Aborted) return "Abort";
    const uint32_t packed = response.error.packed();
    return "error " + text_of(Octets{static_cast<uint8_t>(packed >> 24), static_cast<uint8_t>(packed >> 16),
                                     static_cast<uint8_t>(packed >> 8), static_cast<uint8_t>(packed)});
  }
  // A DP master controls the drive with this configuration.
  void dp(const std::string& cfg, const std::string& outputs) {
    const auto send = [&](std::optional<uint8_t> point, const Octets& data) {
      slave.on_frame(now,
                     make_frame(8, 1, 0x6D, point, point ? std::optional<uint8_t>(62) : std::nullopt, data));
    };
    send(61, hex(prm(kNoWatchdog)));
    send(62, hex(cfg));
    send({}, hex(outputs));
  }

  Mc31 drive;
  FieldbusParameters parameters{drive, mc31_table()};
  DpUnit unit{parameters, drive};
  DpSlave slave{{8, 0x3100}, unit};
  FmsObjects objects;
  fms::Server server;
  Time now = 0;
  Time took = 0;
};

const std::string kDenied = "error 06 03 00 00", kNoObject = "error 06 07 00 00", kType = "error 06 08 00 00";

TEST(FmsObjects, TheList) {
  PROVES("FMS-OBJ-01", "FMS-OBJ-03", "FMS-OBJ-07", "FMS-OBJ-08");
  FmsBench bench;
  bench.open(7);
  struct Row {
    uint16_t index;
    int length;
    fms::Access access;
  };
  const Row kPrinted[] = {
      {988, 2, fms::Access::All},    {989, 4, fms::Access::All},  {990, 6, fms::Access::All},
      {991, 2, fms::Access::Read},   {992, 4, fms::Access::Read}, {993, 6, fms::Access::Read},
      {994, 1, fms::Access::All},    {995, 6, fms::Access::All},  {996, 230, fms::Access::Write},
      {997, 10, fms::Access::Write}, {998, 4, fms::Access::All},  {999, 8, fms::Access::All}};
  const auto list = bench.objects.list();
  ASSERT_EQ(list.size(), std::size(kPrinted) + mc31_table().by_index().size());
  for (size_t n = 0; n < std::size(kPrinted); ++n) {
    EXPECT_EQ(list[n].index, kPrinted[n].index);
    EXPECT_EQ(list[n].length, kPrinted[n].length) << list[n].name;
    EXPECT_EQ(list[n].access, kPrinted[n].access) << list[n].name;
    const fms::Response description = bench.ask(7, fms::Service::GetOvLong, kPrinted[n].index);
    EXPECT_EQ(description.object, list[n]);
  }
  EXPECT_EQ(fms::Object::kObjectCode, 7);
  EXPECT_EQ(fms::Object::kDataType, 10);
  for (size_t n = 0; n < mc31_table().by_index().size(); ++n) {
    const fms::Object& object = list[std::size(kPrinted) + n];
    EXPECT_EQ(object.index, 1000 + mc31_table().by_index()[n]->index);
    EXPECT_EQ(object.length, 4);
    EXPECT_EQ(object.access, fms::Access::All);
  }
  EXPECT_TRUE(std::any_of(list.begin(), list.end(), [](const fms::Object& o) { return o.index == 1025; }));
  for (const int unknown : {0, 987, 1})
    EXPECT_EQ(FmsBench::error(bench.ask(7, fms::Service::GetOvLong, static_cast<uint16_t>(unknown))),
              kNoObject);
  // Each process data object is read and written.
  bench.drive.status = {0x0407, 0x05DC, 0x0123};
  EXPECT_EQ(bench.read(991), "04 07");
  EXPECT_EQ(bench.read(992), "04 07 05 DC");
  EXPECT_EQ(bench.read(993), "04 07 05 DC 01 23");
  for (const uint16_t index : {uint16_t{991}, uint16_t{992}, uint16_t{993}})
    EXPECT_EQ(bench.write(index, Octets(2 * (index - 990U))), kDenied);
  EXPECT_EQ(bench.write(988, "00 06"), "+");
  EXPECT_EQ(bench.drive.output, (std::vector<uint16_t>{6}));
  EXPECT_EQ(bench.read(988), "00 06");
}

TEST(FmsObjects, ThoseOfTheCardNeedNoInverter) {
  PROVES("FMS-OBJ-02");
  FmsBench bench;
  bench.open(7);
  bench.parameters.cut_link(true);
  EXPECT_EQ(bench.read(994), "0B");
  EXPECT_EQ(bench.read(995), "02 05 00 FF 31 00");
  EXPECT_EQ(bench.read(998), "03 E8 00 00");
  EXPECT_EQ(bench.read(1025), "error 06 02 00 00");
  EXPECT_EQ(bench.write(1025, "00 00 09 50"), "error 06 02 00 00");
}

TEST(FmsObjects, WithoutAParameterBehindThem) {
  PROVES("FMS-OBJ-06");
  FmsBench bench;
  bench.open(7);
  EXPECT_EQ(bench.read(1999), "error 08 00 00 10");
  EXPECT_EQ(bench.read(987), kNoObject);
  const fms::Response described = bench.ask(7, fms::Service::GetOvLong, 1018);  // P073, read only
  EXPECT_EQ(described.object->access, fms::Access::All);
  EXPECT_EQ(bench.write(1018, "00 00 00 05"), "error 08 00 00 12");
  EXPECT_EQ(bench.write(1025, "00 00 09"), kType);
}

TEST(FmsObjects, ProcessOutputs) {
  PROVES("FMS-OBJ-11");
  FmsBench bench;
  bench.open(7);
  EXPECT_EQ(bench.write(989, "00 06 05 DC"), "+");
  EXPECT_EQ(bench.drive.output, (std::vector<uint16_t>{6, 1500}));
  EXPECT_EQ(bench.write(990, "00 06 05 DC 00 00"), "+");
  EXPECT_EQ(bench.drive.output, (std::vector<uint16_t>{6, 1500, 0}));
  EXPECT_EQ(bench.write(990, "00 06 05 DC"), kType);
  // Mixed: the DP master controls, FMS reads what it sends, behind the parameter channel.
  bench.dp("F3 F2", "00 00 00 00 00 00 00 00 00 07 01 02 03 04");
  EXPECT_EQ(bench.read(990), "00 07 01 02 03 04");
  EXPECT_EQ(bench.read(988), "00 07");
  EXPECT_EQ(bench.write(990, "00 00 00 00 00 00"), kDenied);
  EXPECT_EQ(bench.drive.output, (std::vector<uint16_t>{7, 0x0102, 0x0304}));
}

TEST(FmsObjects, WordsOfOneObjectAreOfOneCycle) {
  PROVES("FMS-OBJ-10");
  FmsBench bench;
  bench.open(7);
  for (int cycle = 0; cycle < 200; ++cycle) {
    const auto value = static_cast<uint16_t>(0x0101 * (cycle % 256));
    bench.drive.status = {value, value, value};
    const std::string octet = text_of(Octets{static_cast<uint8_t>(cycle)});
    bench.dp("F2", octet + " " + octet + " " + octet + " " + octet + " " + octet + " " + octet);
    for (const uint16_t index : {uint16_t{990}, uint16_t{993}}) {
      const Octets data = hex(bench.read(index));
      EXPECT_EQ(std::set<uint8_t>(data.begin(), data.end()).size(), 1U);
    }
  }
}

TEST(FmsObjects, MinTsdr) {
  PROVES("FMS-OBJ-12");
  FmsBench bench;
  bench.open(7);
  EXPECT_EQ(bench.write(994, "1E"), "+");
  EXPECT_EQ(bench.read(994), "1E");
  EXPECT_EQ(bench.slave.min_tsdr(), 30);
  EXPECT_EQ(bench.write(994, "0A"), "error 08 00 00 16");
  bench.slave.power_on(bench.now,
                       LatchedSwitches({8, false}).slave_settings(option_type(OptionKind::Ffp31), 500'000));
  EXPECT_EQ(bench.read(994), "0B");
}

TEST(FmsObjects, Diagnosis) {
  PROVES("FMS-OBJ-13");
  FmsBench bench;
  bench.open(7);
  bench.dp("F2", "00 00 00 00 00 00");
  bench.slave.set_fault(0, 47);
  bench.now = kSecond;
  const Octets whole = encode(bench.slave.diagnosis(bench.now));
  EXPECT_EQ(whole.size(), 8U);
  EXPECT_EQ(bench.read(995), text_of(std::span(whole).first(6)));
  EXPECT_EQ(bench.write(995, "00 00 00 00 00 00"), kDenied);
}

TEST(FmsObjects, DownloadBlock) {
  PROVES("FMS-OBJ-14", "FMS-OBJ-15", "FMS-OBJ-16");
  FmsBench bench;
  bench.open(7);
  EXPECT_EQ(bench.read(996), kDenied);
  Octets block =
      hex("00 03 04 01 00 00 09 50 04 5D 00 00 00 02 05 73 00 00 00 01");  // P120, P572 and an unknown
  block.resize(230);
  EXPECT_EQ(bench.write(996, block), "error 08 00 03 10");
  block[14] = 0x04;
  block[15] = 0x97;  // 1175: P841
  bench.drive.served.clear();
  EXPECT_EQ(bench.write(996, block), "+");
  EXPECT_EQ(bench.took, 3 * fms::Server::kProcessing);  // the answer comes last
  ASSERT_EQ(bench.drive.served.size(), 3U);
  EXPECT_EQ(bench.drive.served[0].index, 25);
  EXPECT_EQ(bench.drive.served[1].index, 117);
  EXPECT_EQ(bench.drive.served[2].index, 175);
  EXPECT_EQ(bench.drive.values[25], 950);
  EXPECT_EQ(bench.drive.values[117], 2);
  EXPECT_EQ(bench.drive.values[175], 1);
  // Octets by hand against the encoder.
  const std::vector<BlockEntry> entries{{1025, 0x950}, {1117, 2}, {1175, 1}};
  EXPECT_EQ(encode_block(entries), block);
  for (const uint8_t count : {uint8_t{0}, uint8_t{39}, uint8_t{255}}) {
    Octets wrong = block;
    wrong[1] = count;
    EXPECT_EQ(bench.write(996, wrong), kType);
  }
  EXPECT_EQ(bench.write(996, Octets(229)), kType);
}

RC_GTEST_PROP(FmsBlockProperty, EntriesThroughOctets, ()) {
  std::vector<BlockEntry> entries(static_cast<size_t>(*rc::gen::inRange(1, 39)));
  for (BlockEntry& entry : entries)
    entry = {*rc::gen::arbitrary<uint16_t>(), *rc::gen::arbitrary<uint32_t>()};
  RC_ASSERT(encode_block(entries).size() == 230U);
  RC_ASSERT(*decode_block(encode_block(entries)) == entries);
}

TEST(FmsObjects, ABlockStopsAtTheFirstError) {
  PROVES("FMS-OBJ-17", "FMS-OBJ-18");
  FmsBench bench;
  bench.open(7);
  // Twenty times P120, rising, so that the value tells how far it went; the eleventh is too large.
  std::vector<BlockEntry> entries;
  for (uint32_t n = 1; n <= 20; ++n) entries.push_back({1025, *to_bcd(static_cast<int32_t>(n))});
  entries[10].data = 0x99999999;
  EXPECT_EQ(bench.write(996, encode_block(entries)), "error 08 00 0B 15");
  EXPECT_EQ(bench.drive.values[25], 10);
  EXPECT_EQ(bench.drive.served.size(), 11U);
}

TEST(FmsObjects, UniversalWrite) {
  FmsBench bench;
  bench.open(7);
  EXPECT_EQ(bench.write(997, "04 01 00 00 09 50 00 00 00 00"), "+");
  EXPECT_EQ(bench.drive.values[25], 950);
  EXPECT_EQ(bench.read(997), kDenied);
}

TEST(FmsObjects, UniversalRead) {
  PROVES("FMS-OBJ-20", "FMS-OBJ-21", "FMS-OBJ-22", "FMS-OBJ-23");
  FmsBench bench;
  bench.open(7);
  EXPECT_EQ(bench.read(998), "03 E8 00 00");
  bench.drive.values[25] = 950;
  EXPECT_EQ(bench.write(998, "04 01 00 00"), "+");
  EXPECT_EQ(bench.read(999), "00 00 09 50 00 00 00 00");
  EXPECT_EQ(bench.read(998), "04 01 00 00");
  EXPECT_EQ(bench.write(998, "03 E8 00 01"), "+");
  for (const uint16_t index : {uint16_t{0}, uint16_t{1}, uint16_t{2}}) {
    bench.read(999);
    EXPECT_EQ(bench.drive.served.back().index, index);
  }
  EXPECT_EQ(bench.read(998), "03 EB 00 01");
  EXPECT_EQ(bench.write(998, "04 01 FF FF"), "+");
  bench.read(999);
  EXPECT_EQ(bench.read(998), "04 00 FF FF");  // 1025 + 65535 in 16 bits
  const auto values = bench.drive.values;
  EXPECT_EQ(bench.write(999, "04 01 00 00 00 00 00 00"), kDenied);
  EXPECT_EQ(bench.drive.values, values);
}

TEST(FmsServices, BesideDpWhateverTheSwitchSays) {
  PROVES("DP-CFG-20");
  FmsBench bench;
  bench.open(7);
  bench.dp("F2", "00 06 05 DC 00 00");
  EXPECT_EQ(bench.slave.state(), SlaveState::DataExchange);
  EXPECT_EQ(bench.read(1025), "00 00 01 00");
  EXPECT_EQ(bench.read(995), "00 04 00 01 31 00");
  FmsBench small(OptionKind::Size0);
  EXPECT_EQ(small.open(7).end, fms::End::Rejected);
  EXPECT_FALSE(small.server.connected(0));
}

// --- services

TEST(FmsServices, InitiateAndWhatItChecks) {
  PROVES("FMS-SVC-02", "FMS-SVC-03");
  FmsBench bench;
  EXPECT_EQ(bench.open(7).end, fms::End::Positive);
  EXPECT_TRUE(bench.server.is_open(7));
  const fms::MasterEntry good = master_entry(*fms::find_connection(7), 8);
  const auto attempt = [](const fms::MasterEntry& entry) {
    FmsBench fresh;
    const fms::End end = fresh.server.initiate(0, 7, 2, entry).end;
    EXPECT_EQ(fresh.server.is_open(7), end == fms::End::Positive);
    return end;
  };
  fms::MasterEntry wrong = good;
  wrong.features = fms::Features(0x803310000000);  // wants event notification
  EXPECT_EQ(attempt(wrong), fms::End::Error);
  wrong = good;
  wrong.pdu.receive_low = 240;
  EXPECT_EQ(attempt(wrong), fms::End::Error);
  wrong = good;
  wrong.pdu.send_low = 242;
  EXPECT_EQ(attempt(wrong), fms::End::Error);
  wrong = good;
  wrong.pdu.send_high = 1;
  EXPECT_EQ(attempt(wrong), fms::End::Error);
  wrong = good;
  wrong.features = fms::Features(0x002000000000);  // fewer services are allowed
  EXPECT_EQ(attempt(wrong), fms::End::Positive);
}

TEST(FmsServices, InitiateTwiceAborts) {
  PROVES("FMS-SVC-04", "FMS-SVC-05");
  FmsBench bench;
  EXPECT_EQ(bench.open(7).end, fms::End::Positive);
  EXPECT_EQ(bench.open(7).end, fms::End::Aborted);
  EXPECT_EQ(bench.read(1025), "Abort");
  EXPECT_EQ(bench.open(7).end, fms::End::Positive);
  EXPECT_EQ(bench.read(1025), "00 00 01 00");
  bench.server.abort(7);  // of the master: no answer, and no connection
  EXPECT_FALSE(bench.server.is_open(7));
  EXPECT_EQ(bench.open(2).end, fms::End::Positive);
  EXPECT_TRUE(bench.server.expire(bench.now + 30 * kSecond, 2));  // of the slave, by its watch
  EXPECT_FALSE(bench.server.is_open(2));
}

// A connection ends with a request it does not have the time or the room for; others stay as they are.
TEST(FmsServices, WhatEndsAConnection) {
  FmsBench bench;
  EXPECT_EQ(bench.read(1025), "Abort") << "never opened";
  bench.open(7);
  bench.open(8);
  EXPECT_EQ(bench.server.request(0, 7, {fms::Service::Read, 1025, {}}), std::nullopt);
  EXPECT_TRUE(bench.server.busy());
  EXPECT_EQ(bench.server.response(0, 7), std::nullopt) << "not at once";
  EXPECT_EQ(bench.server.response(kSecond, 8), std::nullopt) << "nothing was asked there";
  EXPECT_EQ(bench.server.request(0, 7, {fms::Service::Read, 1025, {}})->end, fms::End::Aborted);
  EXPECT_FALSE(bench.server.is_open(7));
  EXPECT_TRUE(bench.server.is_open(8));
  EXPECT_FALSE(bench.server.busy());
  // Units of data have 241 octets at most.
  bench.open(7);
  EXPECT_EQ(bench.write(1025, Octets(241)), kType);
  EXPECT_TRUE(bench.server.is_open(7));
  EXPECT_EQ(bench.write(1025, Octets(242)), "Abort");
  EXPECT_FALSE(bench.server.is_open(7));
  // One whose control interval is over.
  bench.open(2);
  EXPECT_EQ(bench.server.request(bench.now + 30 * kSecond, 2, {fms::Service::Read, 1025, {}})->end,
            fms::End::Aborted);
  EXPECT_FALSE(bench.server.is_open(2));
  const fms::MasterEntry good = master_entry(*fms::find_connection(7), 8);
  fms::MasterEntry wrong = good;
  wrong.pdu.receive_low = 240;
  EXPECT_EQ(bench.server.initiate(0, 7, 2, wrong).error, (ReturnCode{0, 1, 0}));
  wrong = good;
  wrong.rsap = 24;
  EXPECT_EQ(bench.server.initiate(0, 7, 2, wrong).error, (ReturnCode{0, 2, 0}));
  EXPECT_EQ(bench.server.initiate(0, 99, 2, good).end, fms::End::Rejected);
}

TEST(FmsServices, WhatIsThereAndWhatNot) {
  PROVES("FMS-SVC-01", "FMS-SVC-06");
  FmsBench bench;
  bench.open(8);
  const std::set<fms::Service> answered{
      fms::Service::Identify, fms::Service::GetOvShort, fms::Service::GetOvLong,    fms::Service::Status,
      fms::Service::Read,     fms::Service::Write,      fms::Service::PhysicalRead, fms::Service::PhysicalWrite};
  const fms::Service kAll[] = {
#define FMS_SERVICE(name, feature, confirmed, number, of_object, text) fms::Service::name,
#include "runtime/bus/profibus/fms/services.def"
  };
  for (const fms::Service service : kAll) {
    if (service == fms::Service::Initiate || service == fms::Service::Abort) continue;  // calls of their own
    const fms::Response response = bench.ask(8, service, 1025, hex("00 00 09 50"));
    EXPECT_EQ(response.end != fms::End::Rejected, answered.count(service) == 1)
        << fms::service_type(service).text;
    EXPECT_TRUE(bench.server.is_open(8));
  }
  EXPECT_EQ(bench.ask(8, fms::Service::AcknowledgeEvent).end, fms::End::Rejected);
  EXPECT_EQ(bench.ask(8, fms::Service::AlterEvent).end, fms::End::Rejected);
}

TEST(FmsServices, IdentifyAndStatus) {
  PROVES("FMS-SVC-07", "FMS-SVC-09");
  FmsBench bench;
  bench.open(7);
  EXPECT_EQ(bench.ask(7, fms::Service::Identify).end, fms::End::Positive);
  EXPECT_EQ(bench.server.identity().vendor, "SEW-Eurodrive GmbH & Co");
  EXPECT_EQ(bench.server.identity().model, "MOVITRAC");
  EXPECT_TRUE(std::regex_match(std::string(bench.server.identity().revision), std::regex("821[0-9]{6}")));
  EXPECT_EQ(bench.ask(7, fms::Service::Status).data.size(), 2U);  // logical and physical state, nothing else
}

TEST(FmsServices, GetOvShortAndLong) {
  PROVES("FMS-SVC-08");
  FmsBench bench;
  bench.open(7);
  const fms::Object expected{1025, 4, fms::Access::All, "T11 ramp UP"};
  EXPECT_EQ(bench.ask(7, fms::Service::GetOvShort, 1025).object, expected);
  EXPECT_EQ(bench.ask(7, fms::Service::GetOvLong, 1025).object, expected);
}

TEST(FmsServices, ReadWriteAndTheInvertersReturnCodes) {
  PROVES("FMS-SVC-10", "FMS-SVC-11");
  FmsBench bench;
  bench.open(7);
  EXPECT_EQ(bench.write(1025, "00 00 09 50"), "+");
  EXPECT_EQ(bench.read(1025), "00 00 09 50");
  EXPECT_EQ(bench.write(1025, "99 99 99 99"), "error 08 00 00 15");
  const auto values = bench.drive.values;
  EXPECT_EQ(bench.ask(7, fms::Service::PhysicalWrite, 0, hex("01 02")).end, fms::End::Error);
  EXPECT_EQ(bench.drive.values, values);
}

// --- connections

TEST(FmsConnections, TheList) {
  PROVES("FMS-CRL-01", "FMS-CRL-02", "FMS-CRL-03", "FMS-CRL-12", "FMS-CRL-14");
  const char* kPrinted[] = {"2 MSZY O 20 All All 0 0 0 0 3000",    "3 MSZY O 21 All All 0 0 0 0 3000",
                            "4 MSZY_SI O 22 All All 0 0 1 0 3000", "5 MSZY_SI O 23 All All 0 0 1 0 3000",
                            "6 MSAZ_SI O 24 All All 0 1 1 0 0",    "7 MSAZ O 25 All All 0 1 0 0 0",
                            "8 MSAZ O 26 All All 0 1 0 0 0"};
  ASSERT_EQ(fms::connections().size(), 7U);
  for (size_t n = 0; n < 7; ++n) EXPECT_EQ(describe(fms::connections()[n]), kPrinted[n]);
  for (const int cref : {0, 1, 9, 10}) {
    EXPECT_EQ(fms::find_connection(static_cast<uint8_t>(cref)), nullptr);
    FmsBench bench;
    EXPECT_NE(bench.server.initiate(0, static_cast<uint8_t>(cref), 2, {}).end, fms::End::Positive);
  }
  // Open: whichever master comes.
  for (int master = 0; master < 126; ++master) {
    FmsBench bench;
    EXPECT_EQ(
        bench.server.initiate(0, 7, static_cast<uint8_t>(master), master_entry(*fms::find_connection(7), 8))
            .end,
        fms::End::Positive);
  }
  // One confirmed service at a time.
  FmsBench bench;
  bench.open(7);
  EXPECT_FALSE(bench.server.request(0, 7, {fms::Service::Read, 1025, {}}).has_value());
  EXPECT_TRUE(bench.server.busy());
  EXPECT_EQ(bench.server.request(0, 7, {fms::Service::Read, 1025, {}})->end, fms::End::Aborted);
  EXPECT_FALSE(bench.server.is_open(7));
  // Sizes: a block fits, 242 octets do not.
  bench.open(7);
  EXPECT_NE(bench.ask(7, fms::Service::Write, 996, Octets(230)).end, fms::End::Aborted);
  EXPECT_NE(bench.ask(7, fms::Service::Write, 996, Octets(241)).end, fms::End::Aborted);
  EXPECT_EQ(bench.ask(7, fms::Service::Write, 996, Octets(242)).end, fms::End::Aborted);
}

struct Features {
  uint8_t cref;
  fms::LinkType type;
  std::string octets;
  fms::PduSizes pdu;
  bool reads, writes;
};

TEST(FmsConnections, FeaturesOfEach) {
  PROVES("FMS-CRL-08", "FMS-CRL-09", "FMS-CRL-10");
  const Features kRows[] = {{2, fms::LinkType::MSZY, "00 00 00 00 20 00", {0, 241, 0, 241}, true, false},
                            {3, fms::LinkType::MSZY, "00 00 00 00 10 00", {0, 241, 0, 241}, false, true},
                            {4, fms::LinkType::MSZY_SI, "00 00 10 00 20 00", {241, 241, 0, 241}, true, false},
                            {5, fms::LinkType::MSZY_SI, "00 00 10 00 10 00", {241, 241, 0, 241}, false, true},
                            {6, fms::LinkType::MSAZ_SI, "00 00 10 80 33 06", {0, 241, 0, 241}, true, true},
                            {7, fms::LinkType::MSAZ, "00 00 00 80 33 00", {0, 241, 0, 241}, true, true},
                            {8, fms::LinkType::MSAZ, "00 00 00 80 33 06", {0, 241, 0, 241}, true, true}};
  for (const Features& row : kRows) {
    const fms::Connection& connection = *fms::find_connection(row.cref);
    EXPECT_EQ(connection.type, row.type);
    EXPECT_EQ(text_of(connection.features.octets()), row.octets);
    EXPECT_EQ(connection.pdu, row.pdu);
    FmsBench bench;
    EXPECT_EQ(bench.open(row.cref).end, fms::End::Positive) << int{row.cref};
    EXPECT_EQ(bench.ask(row.cref, fms::Service::Read, 1025).end == fms::End::Positive, row.reads);
    EXPECT_EQ(bench.ask(row.cref, fms::Service::Write, 1025, hex("00 00 09 50")).end == fms::End::Positive,
              row.writes);
    EXPECT_EQ(bench.ask(row.cref, fms::Service::GetOvLong, 1025).end == fms::End::Positive, row.cref >= 6);
    for (const fms::Service event :
         {fms::Service::AcknowledgeEvent, fms::Service::AlterEvent, fms::Service::EventNotification})
      EXPECT_EQ(bench.ask(row.cref, event).end, fms::End::Rejected);
  }
}

TEST(FmsConnections, FeatureBits) {
  PROVES("FMS-CRL-11");
  const auto services = [](uint8_t cref) {
    std::string text;
    for (const std::string& service : fms::find_connection(cref)->features.services()) text += service + " ";
    return text;
  };
  EXPECT_EQ(services(2), "Read.indication ");
  EXPECT_EQ(services(5), "Write.indication Event-Notification.request ");
  EXPECT_EQ(services(6),
            "Get-OV-long.indication Read.indication Write.indication Phys.-Read.indication "
            "Phys.-Write.indication Event-Notification.request Acknowledge-Event-Notification.indication "
            "Alter-Event-Condition-Monitoring.indication ");
  EXPECT_EQ(services(7),
            "Get-OV-long.indication Read.indication Write.indication Phys.-Read.indication "
            "Phys.-Write.indication ");
  std::string master;
  for (const std::string& service : fms::Features(0x803300000000).services()) master += service + " ";
  EXPECT_EQ(master, "Get-OV-long.request Read.request Write.request Phys.-Read.request Phys.-Write.request ");
}

TEST(FmsConnections, WatchedOnes) {
  PROVES("FMS-CRL-13");
  FmsBench bench;
  bench.open(2);
  bench.open(7);
  bench.now = 29'999 * kMillisecond;
  EXPECT_FALSE(bench.server.expire(bench.now, 2));
  EXPECT_EQ(bench.ask(2, fms::Service::Read, 1025).end, fms::End::Positive);
  const Time heard = 29'999 * kMillisecond;
  EXPECT_FALSE(bench.server.expire(heard + 30 * kSecond - 1, 2));
  EXPECT_TRUE(bench.server.expire(heard + 30 * kSecond, 2));
  bench.now = 1'000 * kSecond;
  EXPECT_FALSE(bench.server.expire(bench.now, 7));
  EXPECT_EQ(bench.read(1025), "00 00 01 00");
}

TEST(FmsConnections, EntriesOfAMaster) {
  PROVES("FMS-CRL-15", "FMS-CRL-16", "FMS-CRL-17", "FMS-CRL-18");
  const fms::Connection& slave = *fms::find_connection(7);
  // The example as printed.
  const fms::MasterEntry example{fms::LinkType::MSAZ,          25, 8, {1, 0, 0, 0}, 0, {0, 241, 0, 241},
                               fms::Features(0x803300000000)};
  EXPECT_TRUE(check_master_entry(example, slave).empty());
  EXPECT_EQ(master_entry(slave, 8), example);
  EXPECT_EQ(text_of(example.features.octets()), "80 33 00 00 00 00");
  fms::MasterEntry wrong = example;
  wrong.features = fms::Features(0x803310000000);
  EXPECT_EQ(check_master_entry(wrong, slave),
            (std::vector<std::string>{
                "Event-Notification.request, which the slave does not have as an indication"}));
  wrong = example;
  wrong.pdu.receive_low = 240;
  EXPECT_EQ(check_master_entry(wrong, slave),
            (std::vector<std::string>{"low priority: the master receives 240 octets, the slave sends 241"}));
  wrong = example;
  wrong.counters.scc = 0;
  EXPECT_EQ(check_master_entry(wrong, slave), (std::vector<std::string>{"SCC is 0, RCC of the slave 1"}));
  wrong = example;
  wrong.counters.rcc = 1;
  wrong.rsap = 24;
  wrong.type = fms::LinkType::MSZY;
  EXPECT_EQ(check_master_entry(wrong, slave).size(), 3U);
  wrong = example;
  wrong.pdu.receive_high = 0;
  EXPECT_EQ(check_master_entry(wrong, *fms::find_connection(4)).size(), 8U);
}

}  // namespace
}  // namespace ipos::tests
