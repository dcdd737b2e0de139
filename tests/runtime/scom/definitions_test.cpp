// What the definitions of objects tell: the reason of each refusal, what a definition keeps whatever became of it, and
// warnings.

#include "tests/harness/proves.hpp"
#include "tests/runtime/scom/objects_rig.hpp"

namespace ipos::runtime {
namespace {

// Reasons begin with the number as people read it. Each verdict has its own, and the definition keeps it.
TEST_F(Objects, EveryRefusalHasItsReason) {
  const auto reason = [&] { return std::pair(why_, objects_.definitions().back().why); };
  const auto both = [](const std::string& why) { return std::pair(why, why); };
  cyclic(1024, 100, 0, 9);
  EXPECT_EQ(reason(),
            both("object 400h (1024): Format 0x9 is not 0..8 or 0x100..0x108; the object is not set up"));
  cyclic(2048, 100);
  EXPECT_EQ(reason(), both("object number 2048 is not 0..2047; the object is not set up"));
  cyclic(-1, 100);
  EXPECT_EQ(reason(), both("object number -1 is not 0..2047; the object is not set up"));
  cyclic(1024, 15);
  EXPECT_EQ(reason(),
            both("object 400h (1024): a cycle time of 15 ms is not allowed; the object is not sent"));
  cyclic(2047, 10, 5);
  EXPECT_EQ(reason(),
            both("object 7FFh (2047): an offset of 5 ms is not allowed with 10 ms; the object is not sent"));
  cyclic(2047, 10);
  EXPECT_EQ(reason(), both(""));
  h_[500] = 2047, h_[501] = 10, h_[502] = 0, h_[503] = 8, h_[504] = 426;
  why_.clear();
  EXPECT_TRUE(objects_.define(ObjectKind::TransmitCyclic, 500, h_, why_));
  EXPECT_EQ(reason(),
            both("object 7FFh (2047) is already sent by this unit; the second definition is not used"));
  receive(1025);
  h_[500] = 1025, h_[501] = 8, h_[502] = 431;
  EXPECT_TRUE(objects_.define(ObjectKind::Receive, 500, h_, why_));
  EXPECT_EQ(reason(),
            both("object 401h (1025) is already received by this unit; the second definition is not used"));
  objects_.start(0);
  h_[500] = 1026;
  EXPECT_TRUE(objects_.define(ObjectKind::Receive, 500, h_, why_));
  EXPECT_EQ(why_, "receive object 402h (1026) is defined after _SBusCommOn; it is not used");
}

TEST_F(Objects, ALimitIsNamedWithItsClass) {
  for (int32_t n = 0; n < 6; ++n) cyclic(1024 + n, 9, 0, 0);
  EXPECT_EQ(why_,
            "object 405h (1029): the unit has only 5 transmit objects of 1 to 9 ms; the object is not sent");
  for (int32_t n = 0; n < 11; ++n) cyclic(1050 + n, 10, 0, 0);
  EXPECT_EQ(
      why_,
      "object 424h (1060): the unit has only 10 transmit objects of 10 to 65530 ms in steps of 10; the object is "
      "not sent");
  for (int32_t n = 0; n < 33; ++n) receive(1100 + n);
  EXPECT_EQ(why_, "receive object 46Ch (1132): the unit has only 32 receive objects; it is not used");
}

TEST_F(ObjectsSlowBus, AnOverloadIsTold) {
  cyclic(1024, 1);  // 135 000 of 87 500 bit/s
  EXPECT_EQ(
      why_,
      "object 400h (1024): the cyclic objects of this unit would load the bus beyond 70 %; the object is "
      "not sent");
}

TEST_F(ObjectsB, AnObjectOfSbus2IsTold) {
  receive(kSbus2Object + 1024);
  EXPECT_EQ(why_, "object 400h (1024) is for SBus 2, which the station is not on; the object is not set up");
  EXPECT_TRUE(outbox_.heard.empty());
}

// What could be an object at all has its data in the definition, whatever became of it.
TEST_F(Objects, ADefinitionKeepsWhatItAskedFor) {
  struct Case {
    int32_t id, cycle, offset, format;
    uint32_t data;
  };
  objects_.set_profile({.address = 0, .group = 0});
  // The refused ones first: an accepted one stays.
  for (const Case& c :
       {Case{1025, 15, 0, 8, 426}, Case{1026, 10, 5, 8, 426}, Case{3, 100, 0, 8, 0}, Case{2048, 100, 0, 8, 0},
        Case{-1, 100, 0, 8, 0}, Case{1027, 100, 0, 9, 0}, Case{1024, 100, 50, 0x105, 426}}) {
    cyclic(c.id, c.cycle, c.offset, c.format);
    ASSERT_EQ(objects_.definitions().size(), 1U);
    const ObjectDefinition& kept = objects_.definitions()[0];
    EXPECT_EQ(kept.object, c.id);
    EXPECT_EQ(kept.cycle, c.cycle);
    EXPECT_EQ(kept.offset, c.offset);
    EXPECT_EQ(kept.format.has_value(), c.format != 9);
    EXPECT_EQ(kept.data, c.data) << c.id;
    EXPECT_EQ(kept.accepted, c.id == 1024);
    EXPECT_EQ(kept.why.empty(), c.id == 1024);
  }
}

TEST_F(Objects, OnlyReceiveObjectsListen) {
  cyclic(1024, 100);
  acyclic(1025);
  EXPECT_TRUE(outbox_.heard.empty());
  receive(1026);
  EXPECT_EQ(outbox_.heard, std::vector<uint32_t>{1026});
  receive(1024);
  receive(1026);
  receive(2048);
  EXPECT_EQ(outbox_.heard, std::vector<uint32_t>{1026}) << "what is refused is not heard";
}

// An object with the sync identifier is set up with a warning (docs/reference/protocols/sbus.md).
TEST_F(Objects, TheSyncIdentifierIsWarnedOf) {
  PROVES("VAR-06");
  const std::string warning =
      "object number 7D0h (2000) is also the sync telegram of this unit (P817)";
  SlaveSettings profile{.sync_id = 2000};
  objects_.set_profile(profile);
  EXPECT_EQ(cyclic(2000, 100), 99);
  EXPECT_EQ(why_, warning);
  EXPECT_EQ(objects_.definitions().back().why, warning);
  EXPECT_TRUE(objects_.definitions().back().accepted);
  cyclic(1999, 100);
  EXPECT_EQ(why_, "");
  EXPECT_GE(cyclic(2047, 100), 0);
  EXPECT_EQ(why_, "");
  for (const int32_t id : {-1, 2048}) EXPECT_LT(cyclic(id, 100), 0);
  objects_.stop();
  objects_.set_profile({});  // as from the factory: P817 = 0
  EXPECT_EQ(cyclic(0, 100), 99);
  EXPECT_EQ(why_, "object number 000h (0) is also the sync telegram of this unit (P817)");
  objects_.stop();
  profile.synchronous = false;  // MOVITRAC 07
  objects_.set_profile(profile);
  receive(2000);
  EXPECT_EQ(why_, "");
}

// A one-shot telegram is a second use of its identifier in another structure, also of the same kind, and of another kind
// in the same structure; the same one may be sent again.
TEST_F(Objects, ASecondUseWithAOneShotTelegramIsWarnedOf) {
  const auto warning = [](int32_t first, int32_t second) {
    return "object 400h (1024) stands in two structures of this unit (H" + std::to_string(first) + " and H" +
           std::to_string(second) + "), which may use an identifier once";
  };
  EXPECT_EQ(acyclic(1024, 10), 1);
  EXPECT_EQ(why_, "");
  EXPECT_EQ(acyclic(1024, 10), 1);
  EXPECT_EQ(why_, "") << "the same one again";
  EXPECT_EQ(acyclic(1024, 14), 1);
  EXPECT_EQ(why_, warning(10, 14));
  EXPECT_GE(cyclic(1024, 100), 0);
  EXPECT_EQ(why_, warning(10, 420));
  EXPECT_EQ(acyclic(1025, 420), 1);
  EXPECT_EQ(why_, "") << "another identifier";
}

TEST_F(Objects, TwoKindsInOneStructureAreTwoUses) {
  EXPECT_GE(cyclic(1024, 10), 0);
  EXPECT_EQ(acyclic(1024, 420), 1);
  EXPECT_EQ(why_,
            "object 400h (1024) stands in two structures of this unit (H420 and H420), which may use an "
            "identifier once");
  EXPECT_EQ(objects_.definitions().size(), 2U);
}

// What was refused gives no warning later.
TEST_F(Objects, ARefusedUseIsNoUse) {
  EXPECT_LT(cyclic(1024, 15), 0);
  EXPECT_EQ(acyclic(1024), 1);
  EXPECT_EQ(why_, "");
  EXPECT_EQ(objects_.object(1024)->kind, ObjectKind::TransmitAcyclic);
}

// The last definition of a structure counts, but a refused one does not hide the object that is set up.
TEST_F(Objects, ADefinitionStandsForItsStructure) {
  cyclic(1024, 15);
  ASSERT_EQ(objects_.definitions().size(), 1U);
  EXPECT_FALSE(objects_.definitions()[0].accepted);
  EXPECT_EQ(objects_.object(1024), nullptr);
  cyclic(1025, 17);
  ASSERT_EQ(objects_.definitions().size(), 1U);
  EXPECT_EQ(objects_.definitions()[0].object, 1025);
  EXPECT_EQ(objects_.definitions()[0].cycle, 17);
  cyclic(1026, 50, 120);
  ASSERT_EQ(objects_.definitions().size(), 1U);
  EXPECT_TRUE(objects_.definitions()[0].accepted);
  cyclic(1027, 15);
  ASSERT_EQ(objects_.definitions().size(), 1U);
  EXPECT_EQ(objects_.definitions()[0].object, 1026);
  receive(1030);
  acyclic(1031);
  ASSERT_EQ(objects_.definitions().size(), 3U);
  const ObjectDefinition& sent = *objects_.object(1026);
  EXPECT_EQ(sent.kind, ObjectKind::TransmitCyclic);
  EXPECT_EQ(sent.variable, 420U);
  EXPECT_EQ(sent.format, (VariableFormat{8, VariableLayout::Motorola}));
  EXPECT_EQ(sent.data, 426U);
  EXPECT_EQ(sent.cycle, 50);
  EXPECT_EQ(sent.offset, 120);
  EXPECT_EQ(objects_.object(1030)->data, 431U);
  EXPECT_EQ(objects_.object(1031)->data, 20U);
  EXPECT_EQ(objects_.object(1027), nullptr);
}

}  // namespace
}  // namespace ipos::runtime
