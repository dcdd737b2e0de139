// One master against a hand-driven ring, bit by bit (EN 50170: token, GAP, silence), several frames that wait on a line,
// and every kind of frame in words.
#include <set>

#include "tests/runtime/bus/profibus/line_rig.hpp"

namespace ipos::tests {
namespace {

// At 500 kbaud: a slot of 200 bits; a silence of (6 + 2 n) slots is a lost token to station n.
constexpr Bits kSlot = 200;

// A frame of `octets` that begins at a bit.
struct Spoken {
  Bits begin;
  std::string octets;
  friend bool operator==(const Spoken&, const Spoken&) = default;
  friend void PrintTo(const Spoken& s, std::ostream* out) { *out << s.begin << ": " << s.octets; }
};

struct Ring {
  explicit Ring(MasterSettings settings) : master(rig.add_master(settings)) {}
  // The peer says something `bits` behind the last frame, of whoever it was.
  void say(Bits bits, const Octets& octets) {
    const Bits begin = std::max(rig.line.quiet_since() + bits, rig.line.now());
    ASSERT_TRUE(rig.line.send(peer.id, begin, octets));
    rig.queue.run_until(rig.line.at(begin + 11 * octets.size()));
  }
  void say(Bits bits, const std::string& octets) { say(bits, hex(octets)); }
  // The next frame of the master, by its begin and octets.
  Spoken next() {
    size_t at = rig.recorder.heard.size();
    for (int n = 0; n < 100'000; ++n) {
      rig.run(22 * runtime::kMicrosecond);  // a character
      for (; at < rig.recorder.heard.size(); ++at)
        if (const Heard& heard = rig.recorder.heard[at]; heard.sender == master.node())
          return {bit_from(heard.reception.start, 500'000), heard.text()};
    }
    return {0, "nothing"};
  }
  struct Peer final : Node {
    void on_reception(Time, const Reception&) override {}
    void on_sent(Time) override {}
    NodeId id = 0;
  };
  LineRig rig;
  Peer peer;
  Master& master;
  void attach() { peer.id = rig.line.attach("peer", peer); }
};

MasterSettings station(uint8_t address, uint32_t gap_factor = 1) {
  MasterSettings settings;
  settings.address = address;
  settings.gap_factor = gap_factor;
  settings.highest = 10;
  return settings;
}

// Into the ring with station 5, which answers the poll of its GAP.
void into_ring_with_5(Ring& ring) {
  ring.attach();
  ring.master.start();
  for (int n = 0; n < 20 && ring.master.next_station() != 5; ++n)
    if (ring.next().octets.substr(0, 8) == "10 05 02") ring.say(11, "10 02 05 20 27 16");
  ASSERT_EQ(ring.master.next_station(), 5);
  ASSERT_EQ(ring.next().octets, "DC 05 02");
}

// A line that has been silent for ever belongs to nobody: it is claimed at once, twice, and the token goes round.
TEST(DpRing, ClaimsASilentLine) {
  Ring ring(station(2, 0));
  ring.attach();
  ring.rig.queue.run_until(kSecond);  // bit 500 000
  ring.master.start();
  const Bits first = 500'001 + 33;
  EXPECT_EQ(ring.next(), (Spoken{first, "DC 02 02"}));
  EXPECT_FALSE(ring.master.in_ring());
  EXPECT_EQ(ring.next(), (Spoken{first + 33 + 33, "DC 02 02"}));
  EXPECT_TRUE(ring.master.in_ring());
  // TID2 of 150 bits behind a token, then 33 of SYN.
  EXPECT_EQ(ring.next(), (Spoken{first + 2 * 66 + 150, "DC 02 02"}));
}

TEST(DpRing, WaitsForALineThatWasHeard) {
  Ring ring(station(2, 0));
  ring.attach();
  ring.say(100, "DC 07 08");
  ring.master.start();
  const Bits quiet = ring.rig.line.quiet_since();
  EXPECT_EQ(ring.next(), (Spoken{quiet + 10 * kSlot + 33, "DC 02 02"}));
  // Talk in the silence begins it anew.
  Ring other(station(2, 0));
  other.attach();
  other.say(100, "DC 07 08");
  other.master.start();
  other.say(9 * kSlot, "DC 08 07");
  const Bits again = other.rig.line.quiet_since();
  EXPECT_EQ(other.next(), (Spoken{again + 10 * kSlot + 33, "DC 02 02"}));
}

// Addresses from its own to that of the next master, round the highest; a master that is ready comes into the ring.
TEST(DpRing, PollsItsGap) {
  Ring ring(station(8, 2));
  ring.attach();
  ring.master.start();
  std::vector<std::string> polls;
  int tokens = 0;
  std::vector<int> between;
  while (polls.size() < 22) {
    const std::string octets = ring.next().octets;
    ASSERT_NE(octets, "nothing");
    if (octets.substr(0, 2) == "DC") {
      ++tokens;
      continue;
    }
    polls.push_back(octets.substr(3, 2));
    between.push_back(std::exchange(tokens, 0));
  }
  const std::vector<std::string> round = {"09", "0A", "00", "01", "02", "03", "04", "05", "06", "07"};
  for (size_t n = 0; n < polls.size(); ++n) EXPECT_EQ(polls[n], round[n % 10]) << n;
  for (size_t n = 1; n < between.size(); ++n) EXPECT_EQ(between[n], 2) << "tokens from poll to poll";
  // A slave or a master that is not ready does not come in.
  Ring in(station(2));
  in.attach();
  in.master.start();
  for (const auto& [answer, next] : {std::pair<const char*, uint8_t>{"10 02 03 00 05 16", 2},
                                     {"10 02 04 10 16 16", 2},
                                     {"10 02 05 20 27 16", 5}}) {
    while (in.next().octets.substr(0, 2) != "10") continue;
    in.say(11, answer);
    EXPECT_EQ(in.master.next_station(), next) << answer;
  }
  // From now on the GAP is 3 and 4.
  EXPECT_EQ(in.next().octets, "DC 05 02");
  in.say(33, "DC 02 05");
  EXPECT_EQ(in.next().octets.substr(0, 8), "10 03 02");
}

// Who hears the successor go on has handed the token over; from then on only silence makes a claim.
TEST(DpRing, ATokenThatHasArrived) {
  Octets garbage = hex("DC 07 05");
  garbage[0] = 0x11;
  const Octets heard[] = {hex("DC 07 05"), hex("DC 05 05"), garbage, sd2("89 85 6D 3C 3E"),
                          hex("10 09 05 49 57 16")};
  for (const Octets& octets : heard) {
    Ring ring(station(2));
    into_ring_with_5(ring);
    ring.say(50, octets);
    const Bits quiet = ring.rig.line.quiet_since();
    EXPECT_EQ(ring.next(), (Spoken{quiet + 10 * kSlot + 33, "DC 02 02"})) << text_of(octets);
  }
}

// A token that nobody takes is sent three times; then its station is out of the ring.
TEST(DpRing, ATokenThatNobodyTakes) {
  Ring ring(station(2, 100));
  ring.attach();
  ring.master.start();
  // By hand: station 5 passes the token round three times, so that 2 knows the ring.
  ring.say(100, "DC 05 05");
  for (int n = 0; n < 3; ++n) ring.say(50, "DC 05 05");
  ring.say(50, "10 02 05 49 50 16");
  const Spoken answer = ring.next();
  EXPECT_EQ(answer.octets, "10 05 02 20 27 16") << "ready for the ring";
  EXPECT_EQ(answer.begin, ring.rig.line.quiet_since() - 66);
  ring.say(50, "DC 02 05");
  Spoken token = ring.next();
  EXPECT_EQ(token.octets, "DC 05 02");
  for (int n = 0; n < 2; ++n) {
    const Spoken again = ring.next();
    EXPECT_EQ(again, (Spoken{token.begin + 33 + kSlot + 33, "DC 05 02"})) << n;
    token = again;
  }
  EXPECT_EQ(ring.next(), (Spoken{token.begin + 33 + kSlot + 33, "DC 02 02"}));
  EXPECT_EQ(ring.master.next_station(), 2);
}

// Repeated requests to a slave do not count as attempts of the token behind them.
TEST(DpRing, ATokenBehindASlaveThatDoesNotAnswer) {
  Ring ring(station(2));
  ring.master.add_slave(plan_of(9, "F0", 2));
  into_ring_with_5(ring);
  ring.say(50, "DC 02 05");
  std::string spoken;
  for (int n = 0; n < 7; ++n) spoken += ring.next().octets.substr(0, 5) + " ";
  EXPECT_EQ(spoken, "68 05 68 05 10 03 DC 05 DC 05 DC 05 DC 02 ");
}

// While it listens a master says that it is not ready; two whole rotations make it so.
TEST(DpRing, ListensForTwoRotations) {
  Ring ring(station(2));
  ring.attach();
  ring.master.start();
  const auto status = [&] {
    ring.say(50, "10 02 05 49 50 16");
    return ring.next().octets;
  };
  EXPECT_EQ(status(), "10 05 02 10 17 16");
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(status(), "10 05 02 10 17 16") << n;
    ring.say(50, "DC 07 05");
    ring.say(50, "DC 05 07");
  }
  EXPECT_EQ(status(), "10 05 02 20 27 16");
  // A token that is passed over it is none of its business; one that is meant for it is taken.
  ring.say(50, "DC 07 05");
  ring.say(50, "DC 02 07");
  EXPECT_NE(ring.next().octets, "nothing");
  EXPECT_TRUE(ring.master.in_ring());
}

// A request for something else than the status finds no service, and one without an answer gets none.
TEST(DpRing, RequestsToAMaster) {
  Ring ring(station(2));
  into_ring_with_5(ring);
  ring.say(50, sd2("82 85 6D 3C 3E"));
  EXPECT_EQ(ring.next().octets, "10 05 02 33 3A 16") << "in the ring, no such service";
  for (const char* body : {"82 85 46 3A 3E 00 00", "82 85 44 3A 3E 00 00", "83 85 6D 3C 3E"}) {
    ring.say(50, sd2(body));
    const Bits quiet = ring.rig.line.quiet_since();
    ring.rig.run(kMillisecond);
    EXPECT_EQ(ring.rig.line.quiet_since(), quiet) << body;
  }
}

// Another one that talks while this one has the token: it gives way and listens.
TEST(DpRing, GivesWay) {
  for (const Octets& octets : {hex("DC 07 05"), sd2("89 85 6D 3C 3E")}) {
    Ring ring(station(2));
    into_ring_with_5(ring);
    ring.say(50, "DC 02 05");
    while (ring.next().octets.substr(0, 2) != "10") continue;  // it waits for the answer to its poll
    ring.say(50, octets);
    EXPECT_FALSE(ring.master.in_ring());
    const Bits quiet = ring.rig.line.quiet_since();
    EXPECT_EQ(ring.next(), (Spoken{quiet + 10 * kSlot + 33, "DC 02 02"}));
  }
}

TEST(DpRing, AMasterThatIsPassedOverListensAnew) {
  Ring ring(station(2));
  into_ring_with_5(ring);
  ring.say(50, "DC 07 05");
  EXPECT_TRUE(ring.master.in_ring());
  ring.say(50, "DC 05 07");
  EXPECT_FALSE(ring.master.in_ring()) << "its turn was between the two";
}

// Who is between the sender and the receiver of a token has left, next to either of them, too.
TEST(DpRing, StationsThatATokenPassesOverHaveLeft) {
  Ring ring(station(2));
  ring.attach();
  ring.master.start();
  for (int n = 0; n < 3; ++n)
    for (const char* token : {"DC 04 03", "DC 06 04", "DC 07 06", "DC 03 07"}) ring.say(50, token);
  ring.say(50, "DC 07 03");
  ring.say(50, "DC 02 07");
  ASSERT_TRUE(ring.master.in_ring());
  std::string spoken;
  for (int n = 0; n < 4; ++n) spoken += ring.next().octets + ", ";
  EXPECT_EQ(spoken, "DC 03 02, DC 03 02, DC 03 02, DC 07 02, ") << "3 does not take it, and 4 and 6 are gone";
}

TEST(DpRing, AStoppedMasterIsSilent) {
  Ring ring(station(2));
  into_ring_with_5(ring);
  ring.master.stop();
  ring.say(50, "10 02 05 49 50 16");
  ring.say(50, "DC 02 05");
  const Bits quiet = ring.rig.line.quiet_since();
  ring.rig.run(kSecond);
  EXPECT_EQ(ring.rig.line.quiet_since(), quiet);
  EXPECT_FALSE(ring.master.in_ring());
}

// --- frames that wait on a line

struct Talker final : Node {
  Talker(LineRig& rig, const std::string& name) : id(rig.line.attach(name, *this)) {}
  void on_reception(Time now, const Reception& reception) override {
    heard.emplace_back(now, reception.frame ? "-" : std::string(frame_error_text(reception.frame.error())));
  }
  void on_sent(Time now) override { sent.push_back(now); }
  NodeId id;
  std::vector<std::pair<Time, std::string>> heard;
  std::vector<Time> sent;
};

// A frame that begins behind another one does not collide with it, nor does one that a fault has swallowed.
TEST(DpLine, FramesThatFollowEachOtherDoNotCollide) {
  LineRig rig;
  Talker a(rig, "a"), b(rig, "b"), c(rig, "c");
  const Octets frame = hex("10 03 02 49 4E 16");
  rig.line.send(a.id, 100, frame);
  rig.line.send(b.id, 166 + 33, frame);
  rig.run(kSecond);
  EXPECT_TRUE(rig.recorder.texts.empty());
  EXPECT_EQ(c.heard,
            (std::vector<std::pair<Time, std::string>>{{rig.line.at(166), "-"}, {rig.line.at(265), "-"}}));
  // The other way round, from the last bit to the first one.
  LineRig touching;
  Talker d(touching, "d"), e(touching, "e"), f(touching, "f");
  touching.line.send(d.id, 100, hex("E5"));
  touching.line.send(e.id, 89, hex("E5"));
  touching.run(kSecond);
  EXPECT_TRUE(touching.recorder.texts.empty());
  EXPECT_EQ(f.heard.size(), 2U);
  for (const NodeId swallowed : {NodeId{0}, NodeId{1}}) {
    LineRig lost;
    Talker g(lost, "g"), h(lost, "h"), i(lost, "i");
    OctetFault fault;
    fault.kind = OctetFaultKind::Lost;
    fault.sender = swallowed;
    lost.line.add_fault(fault);
    lost.line.send(g.id, 100, frame);
    lost.line.send(h.id, 130, frame);
    lost.run(kSecond);
    EXPECT_EQ(lost.recorder.texts.size(), 1U) << "that of the fault";
    ASSERT_EQ(i.heard.size(), 1U);
    EXPECT_EQ(i.heard[0].second, "-");
    EXPECT_EQ(g.sent, std::vector{lost.line.at(166)}) << "the sender knows nothing";
  }
}

// Of frames that collide each bit counts once, whoever ends first.
TEST(DpLine, LoadOfCollisions) {
  const auto busy = [](Bits second) {
    LineRig rig;
    Talker a(rig, "a"), b(rig, "b");
    rig.line.send(a.id, 100, hex("10 03 02 49 4E 16"));  // 66 bits
    rig.line.send(b.id, second, hex("E5"));
    rig.run(kSecond);
    return rig.line.load(kSecond).busy_bits;
  };
  EXPECT_EQ(busy(120), 66U) << "within the other one";
  EXPECT_EQ(busy(155), 66U) << "both end at once";
  EXPECT_EQ(busy(160), 71U);
  EXPECT_EQ(busy(166), 77U) << "one behind the other";
  EXPECT_EQ(busy(90), 76U);
  EXPECT_EQ(busy(40), 77U) << "one before the other";
}

TEST(DpLine, IsBusyWhileAFrameCanBeHeard) {
  LineRig rig;
  Talker a(rig, "a"), b(rig, "b");
  rig.line.send(a.id, 100, hex("10 03 02 49 4E 16"));
  for (const Bits bit : {Bits{99}, Bits{100}}) {
    rig.queue.run_until(rig.line.at(bit));
    EXPECT_FALSE(rig.line.is_busy()) << bit;
  }
  for (const Bits bit : {Bits{101}, Bits{165}}) {
    rig.queue.run_until(rig.line.at(bit));
    EXPECT_TRUE(rig.line.is_busy()) << bit;
  }
  EXPECT_EQ(rig.line.quiet_since(), 0U);
  rig.queue.run_until(rig.line.at(166));
  EXPECT_FALSE(rig.line.is_busy());
  EXPECT_EQ(rig.line.quiet_since(), 166U);
  // Cut off in the middle it is silent, and nobody hears the rest.
  rig.line.send(a.id, 300, hex("10 03 02 49 4E 16"));
  rig.queue.run_until(rig.line.at(330));
  rig.line.set_connected(a.id, false);
  rig.line.set_connected(a.id, false);
  EXPECT_FALSE(rig.line.is_busy());
  rig.run(kSecond);
  EXPECT_EQ(rig.line.quiet_since(), 166U);
  EXPECT_EQ(rig.recorder.texts.size(), 1U);
  EXPECT_EQ(rig.line.node_count(), 2U);
  EXPECT_EQ(rig.line.node_name(b.id), "b");
  // A frame to come at the earliest now, none of nothing, and none from who listens elsewhere.
  EXPECT_FALSE(rig.line.send(b.id, 0, Octets{}));
  rig.line.listen_at(b.id, 9600);
  EXPECT_FALSE(rig.line.send(b.id, 0, hex("E5")));
}

// Who listens at another rate hears that something is wrong, and who sends hears nothing.
TEST(DpLine, AnotherRateHearsAnError) {
  LineRig rig;
  Talker a(rig, "a"), b(rig, "b"), c(rig, "c");
  rig.line.listen_at(b.id, 187'500);
  rig.line.send(a.id, 100, hex("10 03 02 49 4E 16"));
  rig.run(kSecond);
  EXPECT_EQ(b.heard, (std::vector<std::pair<Time, std::string>>{
                         {rig.line.at(166), std::string(frame_error_text(FrameError::Framing))}}));
  EXPECT_EQ(c.heard, (std::vector<std::pair<Time, std::string>>{{rig.line.at(166), "-"}}));
  EXPECT_TRUE(a.heard.empty());
  const runtime::LineLoad load = rig.line.load(kSecond);
  EXPECT_EQ(load.frames, 1U);
  EXPECT_EQ(load.busy_bits, 66U);
}

// --- words

TEST(FrameText, EveryKindOfFrame) {
  const std::pair<Octets, const char*> rows[] = {
      {hex("E5"), "short acknowledgement"},
      {hex("DC 02 01"), "1 -> 2 token"},
      {hex("10 03 02 49 4E 16"), "2 -> 3 FDL status"},
      {hex("10 03 02 4E 53 16"), "2 -> 3 ident"},
      {hex("10 03 02 4F 54 16"), "2 -> 3 LSAP status"},
      {hex("10 02 03 00 05 16"), "3 -> 2 OK (slave)"},
      {hex("10 02 03 10 15 16"), "3 -> 2 OK (master, not ready)"},
      {hex("10 02 03 20 25 16"), "3 -> 2 OK (master, ready for the ring)"},
      {hex("10 02 03 30 35 16"), "3 -> 2 OK (master in the ring)"},
      {hex("10 02 03 03 08 16"), "3 -> 2 RS: service or access point not available (slave)"},
      {hex("10 02 03 07 0C 16"), "3 -> 2 function 7h (slave)"},
      {sd2("03 02 6D 01 02"), "2 -> 3 Data_Exchange, SRD high, FCB 1 (first): 01 02"},
      {sd2("03 02 4D 01 02"), "2 -> 3 Data_Exchange, SRD high: 01 02"},
      {sd2("03 02 7C 01 02"), "2 -> 3 Data_Exchange, SRD low, FCB 1: 01 02"},
      {sd2("02 03 08 01 02"), "3 -> 2 Data_Exchange answer, DL: 01 02"},
      {sd2("02 03 0A 01 02"), "3 -> 2 Data_Exchange answer, DH: diagnosis is waiting: 01 02"},
      {sd2("83 82 5D 3B 3E"), "2 -> 3 Get_Cfg, SRD high, FCB 0"},
      {sd2("82 83 08 3E 3B F2"),
       "3 -> 2 Get_Cfg answer, DL: F2 (inputs and outputs of 3 words, consistent as a whole)"},
      {sd2("83 82 5D 3E 3E F3 F0"),
       "2 -> 3 Chk_Cfg, SRD high, FCB 0: F3 F0 (inputs and outputs of 4 words, consistent as a whole + "
       "inputs "
       "and outputs of 1 word, consistent as a whole)"},
      {sd2("83 82 5D 3C 3E"), "2 -> 3 Slave_Diag, SRD high, FCB 0"},
      {sd2("83 82 5D 3C 3E 08 0C 00 02 31 00"), "2 -> 3 Slave_Diag, SRD high, FCB 0: 08 0C 00 02 31 00"},
      {sd2("82 83 08 3E 3C 08 0C"), "3 -> 2 Slave_Diag answer, DL: 08 0C"},
      {sd2("82 83 08 3E 3D B0 00 00 0B 31 00 00"), "3 -> 2 Set_Prm answer, DL: B0 00 00 0B 31 00 00"},
      {sd2("83 82 5D 3D 3E B0 00"), "2 -> 3 Set_Prm, SRD high, FCB 0: B0 00"},
      {sd2("83 82 5D 38 3E 01"), "2 -> 3 RD_Inputs, SRD high, FCB 0: 01"},
      {sd2("FF 82 46 3A 3E 20 00"), "2 -> 127 Global_Control, SDN high: Sync, all"},
      {sd2("FF 82 46 3A 3E 0E 01"), "2 -> 127 Global_Control, SDN high: Clear_Data, Unfreeze, groups 01h"},
      {sd2("FF 82 46 3A 3E 20"), "2 -> 127 Global_Control, SDN high: 20"},
      {sd2("83 82 5D 1E 3E 01"), "2 -> 3 access point 30, SRD high, FCB 0: 01"},
      {sd2("83 82 5D 14 14 00 91 01 A1 02 04 01"), "2 -> 3 FMS connection 2, SRD high, FCB 0: Read 1025, request 1"},
      {sd2("03 82 5D 3E 01"), "2 -> 3 no access point, SRD high, FCB 0: 01"},
      {sd2("83 02 5D 3C"), "2 -> 3 Slave_Diag, SRD high, FCB 0"},
      {sd2("82 03 08 3E 01"), "3 -> 2 no access point answer, DL: 01"}};
  for (const auto& [octets, text] : rows) {
    const auto frame = decode(octets);
    ASSERT_TRUE(frame.has_value()) << text;
    EXPECT_EQ(describe(*frame), text);
  }
}

// The part before the details: what a count of frames is kept by.
TEST(FrameText, Kinds) {
  const auto kind = [](const Octets& octets) { return frame_kind(*decode(octets)); };
  EXPECT_EQ(kind(hex("E5")), "short acknowledgement");
  EXPECT_EQ(kind(hex("DC 02 01")), "1 -> 2 token");
  EXPECT_EQ(kind(hex("10 02 03 20 25 16")), "3 -> 2 OK");
  EXPECT_EQ(kind(hex("10 02 03 03 08 16")), "3 -> 2 RS");
  EXPECT_EQ(kind(sd2("03 02 6D 01 02")), "2 -> 3 Data_Exchange");
  EXPECT_EQ(kind(sd2("02 03 08 01 02")), "3 -> 2 Data_Exchange answer");
}

// EN 50170: octets 1 to 3, each bit by itself.
TEST(FrameText, EveryBitOfTheDiagnosis) {
  const std::pair<const char*, const char*> rows[] = {{"80 04 00", "Master_Lock"},
                                                      {"40 04 00", "Prm_Fault"},
                                                      {"20 04 00", "Invalid_Slave_Response"},
                                                      {"10 04 00", "Not_Supported"},
                                                      {"08 04 00", "Ext_Diag"},
                                                      {"04 04 00", "Cfg_Fault"},
                                                      {"02 04 00", "Station_Not_Ready"},
                                                      {"01 04 00", "Station_Non_Existent"},
                                                      {"00 84 00", "Deactivated"},
                                                      {"00 24 00", "Sync_Mode"},
                                                      {"00 14 00", "Freeze_Mode"},
                                                      {"00 0C 00", "WD_On"},
                                                      {"00 06 00", "Stat_Diag"},
                                                      {"00 05 00", "Prm_Req"},
                                                      {"00 04 80", "Ext_Diag_Overflow"},
                                                      {"00 00 00", "ready"},
                                                      {"00 04 00", "ready"}};
  for (const auto& [octets, text] : rows)
    EXPECT_EQ(describe(*decode_diagnosis(hex(std::string(octets) + " 00 31 00"))),
              std::string(text) + "; master 0, ident 3100h");
  // The fault is told in the form of this unit alone.
  EXPECT_EQ(decode_diagnosis(hex("08 04 00 02 31 00 02 2F"))->fault, 47);
  for (const char* other : {"08 04 00 02 31 00 03 2F", "08 04 00 02 31 00 02", "08 04 00 02 31 00 02 2F 00"})
    EXPECT_EQ(decode_diagnosis(hex(other))->fault, std::nullopt) << other;
}

}  // namespace
}  // namespace ipos::tests
