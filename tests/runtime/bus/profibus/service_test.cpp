// Set_Prm, Global_Control, Slave_Diag and Cfg_Data against the tables of the manual.
#include "runtime/bus/profibus/dp_service.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <set>

#include "runtime/bus/profibus/cfg_data.hpp"
#include "runtime/bus/profibus/frame_text.hpp"
#include "tests/runtime/bus/profibus/octets.hpp"

namespace ipos::tests {
namespace {

TEST(SetPrm, FieldsOfTheCapture) {
  const auto prm = decode_prm(hex("B8 0D 0F 0B 80 E0 00"));
  ASSERT_TRUE(prm.has_value());
  EXPECT_TRUE(prm->lock && prm->sync && prm->freeze && prm->watchdog && !prm->unlock);
  EXPECT_EQ(prm->watchdog_time(), 1'950 * runtime::kMillisecond);
  EXPECT_EQ(prm->min_tsdr, 11);
  EXPECT_EQ(prm->ident, 0x80E0);
  EXPECT_EQ(prm->groups, 0);
  EXPECT_EQ(describe_watchdog(*prm), "1.95 s");
  EXPECT_FALSE(decode_prm(hex("B8 0D 0F 0B 80 E0")).has_value());
}

RC_GTEST_PROP(SetPrmProperty, OctetsThroughFields, ()) {
  const Octets octets = *rc::gen::container<std::vector<uint8_t>>(rc::gen::arbitrary<uint8_t>());
  const auto prm = decode_prm(octets);
  RC_ASSERT(prm.has_value() == (octets.size() >= 7));
  if (prm) RC_ASSERT(encode(*prm) == octets);
}

TEST(GlobalControl, EndingAModeWins) {
  PROVES("DP-SYNC-08");
  const auto word = [](GlobalCommand c) {
    return std::string(c.syncs() ? "S" : "") + (c.unsyncs() ? "s" : "") + (c.freezes() ? "F" : "") +
           (c.unfreezes() ? "f" : "") + (c.clears() ? "C" : "");
  };
  EXPECT_EQ(word({0x20, 0}), "S");
  EXPECT_EQ(word({0x10, 0}), "s");
  EXPECT_EQ(word({0x08, 0}), "F");
  EXPECT_EQ(word({0x04, 0}), "f");
  EXPECT_EQ(word({0x02, 0}), "C");
  EXPECT_EQ(word({0x30, 0}), "s");
  EXPECT_EQ(word({0x0C, 0}), "f");
  EXPECT_EQ(word({0x28, 0}), "SF");
  EXPECT_EQ(word({0x00, 0}), "");
  for (int group = 0; group < 256; ++group)
    for (int mask = 0; mask < 256; ++mask)
      EXPECT_EQ((GlobalCommand{0, static_cast<uint8_t>(group)}.addresses(static_cast<uint8_t>(mask))),
                group == 0 || (group & mask) != 0);
}

TEST(SlaveDiag, OctetsAndWords) {
  PROVES("DP-DIAG-03");
  Diagnosis diagnosis;
  diagnosis.ident = 0x3100;
  diagnosis.master = 2;
  diagnosis.set(diag::kWatchdogOn, true);
  EXPECT_EQ(text_of(encode(diagnosis)), "00 0C 00 02 31 00");
  diagnosis.set(diag::kExtDiag, true);
  diagnosis.fault = 47;
  EXPECT_EQ(text_of(encode(diagnosis)), "08 0C 00 02 31 00 02 2F");
  EXPECT_EQ(*decode_diagnosis(encode(diagnosis)), diagnosis);
  EXPECT_EQ(describe(diagnosis), "Ext_Diag, WD_On; master 2, ident 3100h, fault 47");
  diagnosis.set(diag::kExtDiag, false);
  EXPECT_FALSE(diagnosis.has(diag::kExtDiag));
  EXPECT_FALSE(decode_diagnosis(hex("00 0C 00 02 31")).has_value());
  EXPECT_EQ(describe(*decode_diagnosis(hex("00 0C 00 02 31 00"))), "WD_On; master 2, ident 3100h");
  EXPECT_EQ(describe(*decode_diagnosis(hex("00 04 00 FF 31 11"))), "ready; master none, ident 3111h");
}

CfgModule module_of(const std::string& text) { return decode_cfg(hex(text))->at(0); }

TEST(CfgData, IdentifierOctets) {
  PROVES("DP-CFG-01");
  EXPECT_EQ(module_of("F2"), (CfgModule{3, 3, true, true, true, true}));
  EXPECT_EQ(module_of("31"), (CfgModule{2, 2, false, false, false, false}));
  EXPECT_EQ(module_of("10"), (CfgModule{1, 0, false, false, false, false}));
  EXPECT_EQ(module_of("E1"), (CfgModule{0, 2, false, true, false, true}));
  EXPECT_EQ(module_of("00"), CfgModule{});
  // Special format: 02 octets of outputs, then 3 words of inputs, then two octets of the manufacturer.
  EXPECT_EQ(module_of("C2 01 C2 AA BB"), (CfgModule{3, 2, true, false, true, false}));
  EXPECT_EQ(module_of("4F 81"), (CfgModule{2, 0, false, false, true, false}));
  EXPECT_EQ(module_of("8F C2"), (CfgModule{0, 3, false, true, false, true}));
  EXPECT_EQ(module_of("8F 42"), (CfgModule{0, 3, false, true, false, false}));
  EXPECT_EQ(module_of("8F 82"), (CfgModule{0, 3, false, false, false, true}));
  EXPECT_EQ(module_of("4F C2"), (CfgModule{3, 0, true, false, true, false}));
  EXPECT_EQ(module_of("CF 81 41"), (CfgModule{2, 2, true, false, false, true}));
  EXPECT_EQ(module_of("CF 3F BF"), (CfgModule{64, 64, false, false, true, false}));
  EXPECT_EQ(decode_cfg(hex("C2 01 C2 AA BB 31"))->size(), 2U);
  for (const char* cut : {"C0", "C0 01", "C1 01 01", "40", "80", "01"})
    EXPECT_FALSE(decode_cfg(hex(cut)).has_value()) << cut;
  EXPECT_EQ(describe(module_of("F2")), "inputs and outputs of 3 words, consistent as a whole");
  EXPECT_EQ(describe(module_of("31")), "inputs and outputs of 2 octets");
  EXPECT_EQ(describe(module_of("E0")), "outputs of 1 word, consistent as a whole");
  EXPECT_EQ(describe(module_of("C0 01 C2")), "inputs of 3 words, consistent as a whole; outputs of 2 octets");
}

TEST(CfgData, SixConfigurationsByTotals) {
  PROVES("DP-CFG-02", "DP-CFG-03", "DP-CFG-05");
  // What is accepted: by a sum made here from the bit fields of the norm.
  const auto octets_of = [](int identifier) {
    return ((identifier & 15) + 1) * ((identifier & 0x40) != 0 ? 2 : 1);
  };
  const std::set<int> totals{2, 4, 6, 10, 12, 14};
  std::set<std::string_view> names;
  const auto check = [&](const Octets& cfg) {
    int inputs = 0, outputs = 0;
    for (const uint8_t identifier : cfg) {
      if ((identifier & 0x10) != 0) inputs += octets_of(identifier);
      if ((identifier & 0x20) != 0) outputs += octets_of(identifier);
    }
    const Configuration* found = find_configuration(cfg);
    const bool good = inputs == outputs && totals.count(inputs) == 1;
    ASSERT_EQ(found != nullptr, good) << text_of(cfg);
    if (!good) return;
    EXPECT_EQ(found->octets, inputs);
    EXPECT_EQ(found->octets, 2 * found->words + (found->parameter_channel ? 8 : 0));
    names.insert(found->name);
  };
  for (int first = 0; first < 256; ++first) {
    if ((first & 0x30) == 0) continue;  // the special format: below
    check({static_cast<uint8_t>(first)});
    for (int second = 0; second < 256; ++second)
      if ((second & 0x30) != 0) check({static_cast<uint8_t>(first), static_cast<uint8_t>(second)});
  }
  EXPECT_EQ(names.size(), 6U);
  for (const char* cfg : {"B1", "70", "F0", "31", "C0 01 01", "C0 40 40", "00 F0 00"})
    EXPECT_EQ(find_configuration(hex(cfg))->name, "1 PD") << cfg;
  EXPECT_EQ(find_configuration(hex("F5")), find_configuration(hex("F3 F1")));
  EXPECT_EQ(find_configuration({}), nullptr);
  for (const int octets : {1, 3, 5, 7, 8, 9, 11, 13, 15, 16})
    EXPECT_EQ(find_configuration(Octets{static_cast<uint8_t>(0x30 + octets - 1)}), nullptr) << octets;
  for (const int octets : totals)
    EXPECT_EQ(find_configuration(Octets{static_cast<uint8_t>(0x30 + octets - 1)})->octets, octets);
}

TEST(CfgData, PrintedIdentifiers) {
  const std::pair<std::string, std::string> kPrinted[] = {{"F0", "1 PD"},
                                                          {"F1", "2 PD"},
                                                          {"F2", "3 PD"},
                                                          {"F3 F0", "Param + 1 PD"},
                                                          {"F3 F1", "Param + 2 PD"},
                                                          {"F3 F2", "Param + 3 PD"}};
  ASSERT_EQ(configurations().size(), 6U);
  for (size_t n = 0; n < 6; ++n) {
    EXPECT_EQ(text_of(configurations()[n].cfg_data()), kPrinted[n].first);
    EXPECT_EQ(find_configuration(hex(kPrinted[n].first))->name, kPrinted[n].second);
  }
}

TEST(CfgData, UnequalLengthsAndTheChannelAlone) {
  EXPECT_EQ(find_configuration(hex("D2 E1")), nullptr);  // 6 in, 4 out
  EXPECT_EQ(find_configuration(hex("F3")), nullptr);     // the channel without process data
}

// Ours: a first F3 before others is the parameter channel, as lengths alone are ambiguous.
TEST(CfgData, CardsOfMovidriveAndGateways) {
  const AcceptedWords ten{ConfigurationSet::Movidrive, 1, 10};
  for (int words = 1; words <= 10; ++words) {
    const auto identifier = static_cast<uint8_t>(0xF0 + words - 1);
    const Configuration* plain = find_configuration(Octets{identifier}, ten);
    const Configuration* channel = find_configuration(Octets{0xF3, identifier}, ten);
    ASSERT_TRUE(plain != nullptr && channel != nullptr) << words;
    EXPECT_EQ(plain->words, words);
    EXPECT_FALSE(plain->parameter_channel);
    EXPECT_EQ(channel->words, words);
    EXPECT_TRUE(channel->parameter_channel);
  }
  EXPECT_EQ(find_configuration(hex("FA"), ten), nullptr) << "eleven words";
  EXPECT_EQ(find_configuration(hex("F0 F3"), ten)->words, 5) << "no channel: it does not come first";
  EXPECT_EQ(find_configuration(hex("F3"), {ConfigurationSet::Movidrive, 1, 3}), nullptr)
      << "four words of three";
  for (uint8_t drives = 1; drives <= 8; ++drives) {
    const AcceptedWords exact{ConfigurationSet::Gateway, static_cast<uint8_t>(3 * drives),
                              static_cast<uint8_t>(3 * drives)};
    Octets cfg(drives, 0xF2);
    EXPECT_EQ(find_configuration(cfg, exact)->octets, 6 * drives);
    cfg.insert(cfg.begin(), 0xF3);
    EXPECT_EQ(find_configuration(cfg, exact)->octets, 8 + 6 * drives);
    cfg.push_back(0xF2);
    EXPECT_EQ(find_configuration(cfg, exact), nullptr) << "one drive too many";
  }
}

}  // namespace
}  // namespace ipos::tests
