// FMS on the line: octets built by hand from the rules of the page (public coding of components, heads that are ours), and whole
// services between a master and the card of a MOVITRAC 31, beside DP.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "runtime/bus/profibus/fms_partner.hpp"
#include "runtime/bus/profibus/interface_card.hpp"
#include "tests/runtime/bus/profibus/line_rig.hpp"
#include "tests/runtime/bus/profibus/mc31_rig.hpp"

namespace ipos::tests {
namespace {

std::string words(const std::string& octets) { return fms::describe(hex(octets)); }

struct Printed {
  const char* octets;
  const char* words;
};

// Each message as its octets, taken apart and put together again.
TEST(FmsOctets, ByHand) {
  const Printed kMessages[] = {
      {"01 00 00 E9 02 00 00 12 00 00 21 00 32 00 00 41 00 51 F1 61 00 71 07 F1 76 08 80 33 00 00 00 00",
       "Initiate request, sends 0 and 241 octets, receives 0 and 241, features 80 33 00 00 00 00"},
      {"02 E9 02 00 00 12 00 00 21 00 32 00 00 41 00 51 F1 61 00 71 07 F1 76 08 00 00 00 80 33 00",
       "Initiate response, sends 0 and 241 octets, receives 0 and 241, features 00 00 00 80 33 00"},
      {"00 91 01 A1 02 04 01", "Read 1025, request 1"},
      {"00 A1 01 A1 14 00 00 09 50", "Read to request 1: 00 00 09 50"},
      {"00 91 02 B2 02 04 01 14 00 00 09 50", "Write 1025 = 00 00 09 50, request 2"},
      {"00 A1 02 B0", "Write to request 2: done"},
      {"00 91 03 80", "Status, request 3"},
      {"00 A1 03 82 01 00 11 00", "Status to request 3: 00 00"},
      {"00 91 04 90", "Identify, request 4"},
      {"00 91 05 C2 02 04 01 11 00", "Get-OV 1025, request 5"},
      {"00 91 05 C2 02 04 01 11 FF", "Get-OV-long 1025, request 5"},
      {"00 D1 06 01 09", "answer to request 6: rejected: the service is not there on this connection"},
      {"04 00 00", "Abort: the other side wants it"},
      {"05", "idle"},
  };
  for (const Printed& message : kMessages) {
    const auto decoded = fms::decode(hex(message.octets));
    ASSERT_TRUE(decoded) << message.octets;
    EXPECT_EQ(text_of(fms::encode(*decoded)), message.octets);
    EXPECT_EQ(words(message.octets), message.words);
  }
  // Class 8, code 0, additional 0015h.
  EXPECT_EQ(words("00 B1 02 B2 02 08 00 12 00 15").find("Write to request 2: error, class 8 code 0 additional 15h"), 0U);
  EXPECT_EQ(words("03 E2 02 00 02 12 00 00").find("Initiate error, class 0 code 2"), 0U);
}

TEST(FmsOctets, WhatIsNone) {
  for (const char* octets :
       {"", "06", "FF", "00", "05 00", "04 00", "01 00", "00 91", "00 91 01", "00 91 01 A1", "00 91 01 A1 02", "00 91 01 A1 02 04",
        "00 91 01 A1 02 04 01 00", "00 11 01 A1 02 04 01", "00 C1 01 A1 02 04 01", "00 E0", "01 00 00 91 01 A1 02 04 01",
        "00 91 01 21 02 04 01", "00 91 01 A1 0F", "00 91 01 A1 0F FF 00", "00 91 01 AF FF", "00 92 01 A1 02 04 01"})
    EXPECT_FALSE(fms::decode(hex(octets))) << octets;
}

RC_GTEST_PROP(FmsOctetsProperty, RandomOctetsNeverCrashAndComeBack, (const std::vector<uint8_t>& octets)) {
  const auto decoded = fms::decode(octets);
  if (decoded) RC_ASSERT(*fms::decode(fms::encode(*decoded)) == *decoded);
  fms::describe(octets);
}

// A card on a line with a master of FMS, and a DP master where a test wants it.
struct FmsLine : FmsClient {
  explicit FmsLine(OptionKind kind = OptionKind::Ffp31, bool dp = false, uint8_t other = 2)
      : card(rig.queue, 50, rig.line, "inv", option_type(kind), {8}, drive, mc31_table(), drive),
        partner(other, 8, *this) {
    if (dp) {
      dp_master = &rig.add_master({});
      dp_master->add_slave(plan_of(8, "F2", 6, "88 14 01 0B 31 00 00"));
      dp_master->start();
    }
    MasterSettings settings;
    settings.address = other;
    Master& master = rig.add_master(settings);
    master.add_partner(partner);
    master.start();
    rig.run(2 * kSecond);
  }
  void on_done(uint8_t, uint8_t, const fms::Done& one) override { done = one; }
  // In words, after as long as it takes.
  std::string ask(fms::Service service, uint16_t index = 0, const std::string& data = "", uint8_t cref = 7) {
    done.reset();
    partner.link(*fms::find_connection(cref)).ask({service, index, hex(data)});
    for (int n = 0; n < 10'000 && !done; ++n) rig.run(kMillisecond);
    return done ? fms::describe(done->response) : "nothing";
  }
  LineRig rig;
  Mc31 drive;
  InterfaceCard card;
  FmsPartner partner;
  Master* dp_master = nullptr;
  std::optional<fms::Done> done;
};

TEST(FmsOnTheLine, AllServices) {
  FmsLine bench;
  bench.drive.values[25] = 950;
  EXPECT_EQ(bench.ask(fms::Service::Read, 1025), "00 00 09 50");
  EXPECT_EQ(bench.ask(fms::Service::Write, 1025, "00 00 01 20"), "done");
  EXPECT_EQ(bench.drive.values[25], 120);
  EXPECT_EQ(bench.ask(fms::Service::Identify).find("SEW-Eurodrive GmbH & Co, MOVITRAC, 821"), 0U);
  EXPECT_EQ(bench.ask(fms::Service::Status), "00 00");
  EXPECT_EQ(bench.ask(fms::Service::GetOvLong, 991), "991: object code 7, data type 10, 2 octets, read all");
  EXPECT_EQ(bench.ask(fms::Service::GetOvLong, 996), "996: object code 7, data type 10, 230 octets, write all");
  EXPECT_EQ(bench.ask(fms::Service::GetOvShort, 1025), "1025: object code 7, data type 10, 4 octets, read all / write all");
  EXPECT_EQ(bench.ask(fms::Service::PhysicalWrite, 0, "01").find("error, class 6 code 6"), 0U);
  EXPECT_EQ(bench.ask(fms::Service::AcknowledgeEvent), "rejected: the service is not there on this connection");
  EXPECT_EQ(bench.ask(fms::Service::Read, 987).find("error, class 6 code 7"), 0U);
  std::string block = "00 01 04 01 00 00 09 50";
  for (size_t n = 8; n < 230; ++n) block += " 00";
  EXPECT_EQ(bench.ask(fms::Service::Write, 996, block), "done");
  EXPECT_EQ(bench.drive.values[25], 950);
  EXPECT_EQ(bench.ask(fms::Service::Abort), "done");
  EXPECT_FALSE(bench.card.fms().connected(bench.rig.queue.now()));
  EXPECT_EQ(bench.ask(fms::Service::Read, 1025), "00 00 09 50") << "opens it anew";
  EXPECT_EQ(bench.ask(fms::Service::Initiate), "aborted: the connection was open");
  EXPECT_EQ(bench.ask(fms::Service::Initiate), "done");
}

// Row by row of the list: what a connection does not have is rejected, and it stays open.
TEST(FmsOnTheLine, ConnectionsHaveTheirServicesAlone) {
  FmsLine bench;
  for (const fms::Connection& connection : fms::connections()) {
    const auto ask = [&](fms::Service service, const std::string& data = "") {
      return bench.ask(service, 1025, data, connection.cref);
    };
    const std::string kRejected = "rejected: the service is not there on this connection";
    EXPECT_EQ(ask(fms::Service::Read) != kRejected, connection.features.responds(fms::Service::Read)) << int{connection.cref};
    EXPECT_EQ(ask(fms::Service::Write, "00 00 09 50") != kRejected, connection.features.responds(fms::Service::Write));
    EXPECT_EQ(ask(fms::Service::GetOvLong) != kRejected, connection.features.responds(fms::Service::GetOvLong));
    EXPECT_EQ(ask(fms::Service::Status) != kRejected, !fms::is_cyclic(connection.type));
    EXPECT_TRUE(bench.card.fms().is_open(connection.cref));
  }
  // A watched connection is kept alive by its master, and ends without it.
  bench.rig.run(60 * kSecond);
  EXPECT_TRUE(bench.card.fms().connected(bench.rig.queue.now()));
  EXPECT_EQ(bench.ask(fms::Service::Read, 1025, "", 2), "00 00 09 50");
}

TEST(FmsOnTheLine, BesideDp) {
  FmsLine bench(OptionKind::Ffp31, true);
  EXPECT_TRUE(bench.dp_master->slave(0).exchanging());
  bench.dp_master->slave(0).set_outputs(hex("00 06 05 DC 00 00"));
  bench.rig.run(100 * kMillisecond);
  EXPECT_EQ(bench.ask(fms::Service::Read, 990), "00 06 05 DC 00 00");
  EXPECT_EQ(bench.ask(fms::Service::Write, 990, "00 00 00 00 00 00").find("error, class 6 code 3"), 0U);
  EXPECT_TRUE(bench.dp_master->slave(0).exchanging());
  const uint64_t before = bench.dp_master->slave(0).exchanges();
  bench.rig.run(100 * kMillisecond);
  EXPECT_GT(bench.dp_master->slave(0).exchanges(), before + 20);
  FmsLine small(OptionKind::Size0);
  EXPECT_EQ(small.ask(fms::Service::Read, 1025), "aborted: nobody answers");
}

// Frames as a foreign master sends them, straight to the slave.
struct Raw {
  std::string send(const std::string& data, uint8_t master = 2, uint8_t point = 25, uint8_t own_point = 40) {
    const auto answer = slave.on_frame(now, make_frame(8, master, 0x6C, point, own_point, hex(data)));
    if (answer->is_acknowledgement()) return "E5";
    return answer->answers(FdlAnswer::NoService) ? "RS" : text_of(answer->data);
  }
  Mc31 drive;
  FieldbusParameters parameters{drive, mc31_table()};
  DpUnit unit{parameters, drive};
  DpSlave slave{{8, 0x3100}, unit};
  FmsObjects objects{parameters, drive, slave};
  fms::Server server{objects, true};
  fms::SlaveLinks links{server};
  Time now = 0;
  Raw() { slave.set_fms(links); }
};

constexpr const char* kInitiate = "01 00 00 E9 02 00 00 12 00 00 21 00 32 00 00 41 00 51 F1 61 00 71 07 F1 76 08 80 33 00 00 00 00";

TEST(FmsOnTheLine, WhatAForeignMasterMeets) {
  Raw raw;
  EXPECT_EQ(raw.send("00 91 01 A1 02 04 01"), "04 02 04") << "not open";
  EXPECT_EQ(raw.send(kInitiate).substr(0, 5), "02 E9");
  EXPECT_EQ(raw.send("00 91 01 A1 02 04 01", 3), "RS") << "another master";
  EXPECT_EQ(raw.send("00 91 01 A1 02 04 01", 2, 25, 41), "RS") << "another access point";
  EXPECT_EQ(raw.send("00 91 01 A1 02 04 01"), "E5");
  EXPECT_EQ(raw.send(""), "E5");
  raw.now += 10 * kMillisecond;
  EXPECT_EQ(raw.send(""), "00 A1 01 A1 14 00 00 01 00");
  EXPECT_EQ(raw.send(""), "E5") << "given once";
  EXPECT_EQ(raw.send("00 91 02 DF 02 04 01"), "04 01 08") << "malformed";
  EXPECT_EQ(raw.send(kInitiate).substr(0, 5), "02 E9");
  EXPECT_EQ(raw.send(kInitiate), "04 02 03") << "was open";
  EXPECT_EQ(raw.send(kInitiate).substr(0, 5), "02 E9");
  EXPECT_EQ(raw.send("00 91 07 F0 1D"), "00 D1 07 01 09") << "an unknown service number, 29, is rejected";
  EXPECT_EQ(raw.send("00 91 01 A1 02 04 01"), "E5");
  EXPECT_EQ(raw.send("00 91 02 A1 02 04 01"), "04 02 06") << "a second request before the answer";
  EXPECT_EQ(raw.send(kInitiate).substr(0, 5), "02 E9");
  EXPECT_EQ(raw.send("04 00 00"), "E5");
  EXPECT_FALSE(raw.server.is_open(7));
  // Sizes and features that do not fit.
  std::string wrong = kInitiate;
  wrong.replace(wrong.rfind("F1"), 2, "F0");
  EXPECT_EQ(raw.send(wrong), "03 E2 02 00 01 12 00 00");
  wrong = kInitiate;
  wrong.replace(wrong.find("80 33 00"), 8, "80 33 10");
  EXPECT_EQ(raw.send(wrong), "03 E2 02 00 02 12 00 00");
  // Watched: CREF 2 after 30 s.
  std::string cyclic = kInitiate;
  cyclic.replace(cyclic.find("80 33"), 5, "00 20");
  EXPECT_EQ(raw.send(cyclic, 2, 20).substr(0, 5), "02 E9");
  raw.now += 30 * kSecond;
  EXPECT_EQ(raw.send("", 2, 20), "04 02 05");
}

}  // namespace
}  // namespace ipos::tests
