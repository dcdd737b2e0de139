// The trace: which telegrams a filter takes, what one of them says, what belongs to it, and the files of other tools.
#include <fmt/format.h>

#include <sstream>

#include "tests/serve/bytes_of_text.hpp"
#include "tests/serve/serving.hpp"
#include "tools/logs/log_forms.hpp"
#include "tools/serve/host/trace_filter.hpp"

namespace ipos::tests {
namespace {

using tools::serve::FilteredTelegram;
using tools::serve::Mistake;
using tools::serve::TraceFilter;

// A telegram as the filter's description names its parts.
class Made final : public FilteredTelegram {
 public:
  const std::string& line() const override { return line_; }
  std::optional<uint32_t> id() const override { return id_; }
  std::string identity() const override { return "523 20B"; }
  std::vector<uint32_t> addresses() const override { return addresses_; }
  std::string data() const override { return "31002146"; }
  size_t length() const override { return 4; }
  std::string sender() const override { return "saw"; }
  const std::string& words() const override {
    ++asked;
    return words_;
  }
  bool is_error() const override { return false; }
  bool is_remote() const override { return false; }
  bool is_extended() const override { return false; }
  bool is_ours() const override { return true; }

  std::optional<uint32_t> id_ = 0x20B;
  std::vector<uint32_t> addresses_;
  mutable int asked = 0;

 private:
  std::string line_ = "sbus", words_ = "20B read 8518 Speed -> lift";
};

bool takes(const char* filter, const Made& telegram = {}) { return TraceFilter(filter).takes(telegram); }

TEST(Filter, AllWordsMustFitAndOneWithAMinusMustNot) {
  EXPECT_TRUE(takes(""));
  EXPECT_TRUE(takes("read lift"));
  EXPECT_FALSE(takes("read belt"));
  EXPECT_FALSE(takes("-read"));
  EXPECT_TRUE(takes("-token -belt"));
  EXPECT_FALSE(takes("read -SPEED")) << "large and small letters are the same";
  EXPECT_TRUE(takes("\"8518 speed\""));
  EXPECT_FALSE(takes("\"speed 8518\""));
  EXPECT_TRUE(takes("sbus 523 2146 saw")) << "line, identity, data and sender are found without a name, too";
}

TEST(Filter, NamedPartsAreLookedAtAlone) {
  for (const char* filter : {"id:20B", "id:20b", "id:0x20B", "id:20Bh", "id:100-20F", "id:1,20B", "line:SBUS", "sender:saw",
                             "data:2146", "data:31", "dlc:4", "dlc:0-8", "is:ours", "text:lift", "id:20B -token sender:saw read"})
    EXPECT_TRUE(takes(filter)) << filter;
  for (const char* filter : {"id:20C", "id:523", "-id:20B", "line:sb", "sender:sa", "data:1002", "data:2147", "dlc:3", "is:foreign",
                             "is:error", "-is:ours", "text:belt", "address:1"})
    EXPECT_FALSE(takes(filter)) << filter;
  Made frame;
  frame.id_.reset();
  frame.addresses_ = {1, 9};
  EXPECT_TRUE(takes("address:9", frame));
  EXPECT_TRUE(takes("address:2-9", frame));
  EXPECT_FALSE(takes("address:8", frame));
  EXPECT_FALSE(takes("id:0-7FF", frame)) << "frames of PROFIBUS have no identifier";
}

// While somebody types, the filter is never complete.
TEST(Filter, HalfAWordTakesAllAndAWrongOneIsSaid) {
  for (const char* filter : {"id:", "-", "-id:", "\"", "sender:", "data:,"}) EXPECT_TRUE(takes(filter)) << filter;
  const auto wrong = [](const std::string& filter) -> std::string {
    try {
      TraceFilter{filter};
    } catch (const Mistake& mistake) {
      return mistake.what();
    }
    return {};
  };
  EXPECT_EQ(wrong("id:saw"), "'saw' is no hexadecimal number and no range of them");
  EXPECT_EQ(wrong("dlc:1-x"), "'1-x' is no number and no range of them");
  EXPECT_EQ(wrong("is:blue"), "'blue' is none of error, remote, extended, ours, foreign");
  EXPECT_EQ(wrong("data:xy"), "'xy' are no bytes in hexadecimal");
  EXPECT_EQ(wrong(std::string(1001, 'a')), "a filter has at most 1000 characters");
}

TEST(Filter, WordsAreMadeOnlyWhereTheyAreWanted) {
  Made telegram;
  EXPECT_FALSE(takes("speed id:20C", telegram));
  EXPECT_EQ(telegram.asked, 0) << "the identifier decides";
  EXPECT_FALSE(TraceFilter("id:20B -line:dp").needs_words());
  EXPECT_TRUE(TraceFilter("id:20B speed").needs_words());
}

constexpr const char* kLines =
    "[[bus]]\nname = \"sbus\"\nkind = \"can\"\n[[bus]]\nname = \"wire\"\nkind = \"rs485\"\n"
    "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\n"
    "[[station]]\nname = \"belt\"\nunit = \"mdxb\"\nsbus = \"sbus\"\nrs485 = \"wire\"\n[station.parameters]\nP881 = 4\n"
    "[[station]]\nname = \"pump\"\nunit = \"mc31\"\noption = \"ffp31\"\nprofibus = \"dp\"\nprofibus_address = 9\n"
    "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\naddress = 1\n[[control.slave]]\naddress = 9\ncfg = \"F3 F2\"\n"
    "watchdog = \"200ms\"\npo = [6, 1500, 0]\n";

class OnTrace : public Serving {
 protected:
  OnTrace() : Serving(plant_of(kLines)) {}

  void send(uint32_t id, const char* data) {
    good({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", id}, {"data", data}});
    step(5);
  }
  Json trace(Json more) {
    more["do"] = "bus.trace";
    return good(more)["frames"];
  }
  Json detail(const Json& frame) { return good({{"do", "bus.telegram"}, {"bus", frame["bus"]}, {"n", frame["n"]}}); }
  static Json field(const Json& detail, const std::string& signal) {
    for (const Json& one : detail["fields"])
      if (one["signal"] == signal) return one["value"];
    return nullptr;
  }
};

TEST_F(OnTrace, ATelegramHasItsSenderAndItsLength) {
  send(523, "0102");
  const Json frame = trace({{"bus", "sbus"}})[0];
  EXPECT_EQ(frame["sender"], "the page");
  EXPECT_EQ(frame["ours"], true);
  EXPECT_EQ(frame["dlc"], 2);
  // ISO 11898: 44 bits and 16 of data up to the end of the frame, and at most 12 stuffed ones, of 2 us each.
  EXPECT_GE(frame["took_us"].get<double>(), 120);
  EXPECT_LE(frame["took_us"].get<double>(), 144);
  step(300);
  EXPECT_EQ(trace({{"bus", "dp"}, {"filter", "sender:plc -token Set_Prm"}})[0]["sender"], "plc");
  EXPECT_EQ(trace({{"bus", "dp"}, {"filter", "sender:pump \"Slave_Diag answer\""}})[0]["sender"], "pump");
  for (const Json& one : trace({{"filter", "-token"}}))
    EXPECT_EQ(one["text"].get<std::string>().find("token"), std::string::npos) << one;
}

// Whoever follows asks for what is new; whoever looks back, for what came before.
TEST_F(OnTrace, NewOnesComeBehindTheLastAndPausedOnesNotAtAll) {
  for (const char* data : {"01", "02", "03"}) send(523, data);
  send(524, "04");
  const Json all = good({{"do", "bus.trace"}, {"bus", "sbus"}});
  ASSERT_EQ(all["frames"].size(), 4U);
  const Json news = trace({{"bus", "sbus"}, {"after", all["frames"][1]["n"]}});
  ASSERT_EQ(news.size(), 2U);
  EXPECT_EQ(news[0]["data"], "03");
  EXPECT_EQ(trace({{"bus", "sbus"}, {"after", all["last"]}}), Json::array());
  const Json paused = Json::array({{{"bus", "sbus"}, {"id", 523}, {"extended", false}, {"remote", false},
                                    {"since", all["frames"][1]["n"]}}});
  const Json kept = trace({{"bus", "sbus"}, {"paused", paused}});
  ASSERT_EQ(kept.size(), 3U) << "those before the pause stay";
  EXPECT_EQ(kept[1]["data"], "02");
  EXPECT_EQ(kept[2]["id"], 524);
  EXPECT_EQ(error({{"do", "bus.trace"}, {"paused", 7}}), "'paused' must be a list of at most 500");
  EXPECT_EQ(error({{"do", "bus.trace"}, {"paused", {{{"bus", "none"}, {"id", 1}}}}}), "there is no bus 'none'");
}

// 8 x 4 + 515 = 547 asks belt, 548 is its answer (1053 1610 p. 37). 31h reads; 2116h = 8470 is P130, 2 s as delivered.
TEST_F(OnTrace, AQuestionLeadsToItsAnswerAndBack) {
  send(547, "3100211600000000");
  step(30);
  const Json question = trace({{"bus", "sbus"}, {"filter", "id:223"}})[0];
  const Json asked = detail(question);
  ASSERT_FALSE(asked["answer"].is_null()) << asked;
  EXPECT_EQ(asked["answer"]["id"], 548);
  EXPECT_EQ(asked["question"], nullptr);
  EXPECT_EQ(field(asked, "sbus.223.index"), 8470);
  EXPECT_EQ(field(asked, "sbus.223.service"), 1);
  const Json answered = detail(asked["answer"]);
  EXPECT_EQ(answered["question"]["n"], question["n"]);
  EXPECT_EQ(answered["answer"], nullptr);
  EXPECT_EQ(field(answered, "sbus.224.value"), 2000);
  EXPECT_EQ(answered["telegram"]["sender"], "belt");
  EXPECT_EQ(answered["channels"], true);
  // The signals are those that the scope takes.
  good({{"do", "scope"}, {"channels", {"sbus.224.value"}}});
  EXPECT_EQ(error({{"do", "bus.telegram"}, {"bus", "sbus"}, {"n", 1'000'000}}), "telegram 1000000 of sbus is not kept any more");
}

TEST_F(OnTrace, AQuestionThatIsAskedAgainIsNotAnsweredBefore) {
  // A group hears and does not answer: 8 x 4 + 6 with 512 (1053 1610 p. 37).
  send(550, "3100211600000000");
  const Json to_group = trace({{"bus", "sbus"}, {"filter", "id:226"}})[0];
  EXPECT_EQ(detail(to_group)["answer"], nullptr);
  // Both are on the line before the unit answers, some milliseconds later.
  for (int n = 0; n < 2; ++n)
    good({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", 547}, {"data", "3100211600000000"}});
  step(50);
  const Json questions = trace({{"bus", "sbus"}, {"filter", "id:223"}});
  const Json answers = trace({{"bus", "sbus"}, {"filter", "id:224"}});
  ASSERT_EQ(questions.size(), 2U);
  ASSERT_FALSE(answers.empty());
  ASSERT_LT(questions[1]["n"], answers[0]["n"]);
  EXPECT_EQ(detail(questions[0])["answer"], nullptr);
  EXPECT_EQ(detail(questions[1])["answer"]["n"], answers[0]["n"]);
}

// 1053 1610 p. 18-25: 02h, address 0, TYP 86h, 31h reads index 2116h; the block check is the exclusive-or of all bytes.
TEST_F(OnTrace, SerialTelegramsAndFramesOfDpFindTheirAnswersToo) {
  good({{"do", "bus.send"}, {"bus", "wire"}, {"data", "020086310021160000000082"}});
  step(100);
  const Json heard = trace({{"bus", "wire"}});
  ASSERT_EQ(heard.size(), 2U) << heard;
  const Json asked = detail(heard[0]);
  EXPECT_EQ(asked["answer"]["n"], heard[1]["n"]);
  EXPECT_EQ(field(asked, "wire.0.request_index"), 8470);
  EXPECT_EQ(field(detail(heard[1]), "wire.0.answer_value"), 2000);
  EXPECT_EQ(detail(heard[1])["question"]["n"], heard[0]["n"]);
  step(500);
  // The newest question may still wait for its answer.
  const Json exchanges = trace({{"bus", "dp"}, {"filter", "sender:plc Data_Exchange"}});
  ASSERT_GE(exchanges.size(), 2U);
  const Json said = detail(exchanges[exchanges.size() - 2]);
  EXPECT_EQ(field(said, "dp.9.PO1"), 6);
  EXPECT_EQ(field(said, "dp.9.PO2"), 1500);
  EXPECT_EQ(field(said, "dp.9.PI1"), nullptr) << "that is of the answer";
  ASSERT_FALSE(said["answer"].is_null()) << said;
  EXPECT_EQ(said["answer"]["source"], 9);
  EXPECT_FALSE(field(detail(said["answer"]), "dp.9.PI1").is_null());
}

// The master has sent F3 F2: eight octets of parameter channel, three words. 1500 digits of 0.2 rpm are 300 rpm.
TEST_F(OnTrace, DataOfDpAreNamedByTheConfigurationOfTheSlave) {
  step(1000);
  const Json sent = trace({{"bus", "dp"}, {"filter", "sender:plc Data_Exchange"}}).back();
  const std::string text = sent["text"];
  EXPECT_NE(text.find("Data_Exchange, SRD"), std::string::npos) << text;
  EXPECT_NE(text.find(": no service, PO CTRL. WORD 1 0006h (enable), SPEED 300.0 rpm, RAMP 0 ms -> pump"), std::string::npos) << text;
  const std::string answer = trace({{"bus", "dp"}, {"filter", "sender:pump Data_Exchange"}}).back()["text"];
  EXPECT_NE(answer.find("PI STATUS WORD1 "), std::string::npos) << answer;
  EXPECT_TRUE(answer.ends_with(" <- pump")) << answer;
}

// What nobody in the plant has says its bytes.
TEST_F(OnTrace, AnUnknownTelegramSaysItsBytes) {
  send(0x7F0, "0AFF");
  const Json said = detail(trace({{"bus", "sbus"}})[0]);
  EXPECT_EQ(said["fields"].size(), 2U) << said;
  EXPECT_EQ(field(said, "sbus.7F0.B1"), 255);
}

// --- files

struct Read {
  std::vector<runtime::LogEntry> can;
  std::vector<runtime::SerialEntry> serial;
  std::vector<runtime::ProfibusEntry> dp;
  std::vector<std::string> wrong;
};

Read read_all(const std::string& bytes) {
  Read out;
  tools::read_log(bytes, {[&](const auto& entry, tools::LogPlace) { out.can.push_back(entry); },
                   [&](const auto& entry, tools::LogPlace) { out.serial.push_back(entry); },
                   [&](const auto& entry, tools::LogPlace) { out.dp.push_back(entry); },
                   [&](tools::LogPlace, const std::string& message) { out.wrong.push_back(message); }});
  return out;
}

TEST_F(OnTrace, IsSavedInTheFormsOfOtherTools) {
  send(523, "0102");
  good({{"do", "bus.send"}, {"bus", "wire"}, {"data", "020086310021160000000082"}});
  step(300);
  const Json on_can = trace({{"bus", "sbus"}});
  for (const char* form : {"candump", "asc"}) {
    const Json reply = good({{"do", "bus.save"}, {"form", form}, {"bus", "sbus"}});
    EXPECT_EQ(reply["next"], nullptr);
    const Read log = read_all(reply["text"]);
    EXPECT_TRUE(log.wrong.empty()) << log.wrong.front();
    ASSERT_EQ(log.can.size(), on_can.size()) << form;
    EXPECT_EQ(log.can[0].frame.id, 523U);
    EXPECT_EQ(log.can[0].time / 1'000, on_can[0]["us"].get<int64_t>()) << form;
  }
  const Json reply = good({{"do", "bus.save"}, {"form", "pcapng"}});
  EXPECT_EQ(reply["file"], "trace.pcapng");
  const Read log = read_all(bytes_of_base64(reply["base64"]));
  EXPECT_TRUE(log.wrong.empty()) << log.wrong.front();
  EXPECT_EQ(log.can.size(), on_can.size());
  EXPECT_EQ(log.serial.size(), trace({{"bus", "wire"}, {"limit", 1000}}).size());
  EXPECT_EQ(log.dp.size(), trace({{"bus", "dp"}, {"limit", 1000}}).size());
  EXPECT_EQ(reply["telegrams"], log.can.size() + log.serial.size() + log.dp.size());
  ASSERT_FALSE(log.serial.empty());
  // 12 characters of 11 bits at 9600 Bd: 13.75 ms.
  EXPECT_NEAR(static_cast<double>(log.serial[0].reception.end - log.serial[0].reception.start), 0, 20e6);
}

TEST_F(OnTrace, WhatAFormHasNoPlaceForIsLeftOutAndSaid) {
  send(523, "0102");
  const std::string why = "wire is a RS-485 line, and candump has a place for CAN frames only; pcapng carries it";
  EXPECT_EQ(error({{"do", "bus.save"}, {"form", "candump"}, {"bus", "wire"}}), why);
  const Json reply = good({{"do", "bus.save"}, {"form", "candump"}});
  ASSERT_EQ(reply["left_out"].size(), 2U) << reply;
  EXPECT_EQ(reply["left_out"][0], why);
  EXPECT_EQ(reply["telegrams"], 1);
  EXPECT_EQ(error({{"do", "bus.save"}, {"form", "blf"}}), "'form' must be candump, asc or pcapng, not 'blf'");
}

// A DP slave answers at once or not at all: what anybody says after the next frame is no answer to this one.
TEST_F(OnTrace, AFrameToNobodyHasNoAnswer) {
  step(1000);
  // SD1, DA 77, SA 1, FDL status, and the sum of the three (PROFIBUS FDL): there is no station 77.
  good({{"do", "bus.send"}, {"bus", "dp"}, {"data", "104D01499716"}});
  step(200);
  const Json to_nobody = trace({{"bus", "dp"}, {"filter", "sender:\"the page\""}});
  ASSERT_EQ(to_nobody.size(), 1U);
  EXPECT_EQ(detail(to_nobody[0])["answer"], nullptr);
  // A short acknowledgement that anybody sends now has nobody's address: it answers nothing.
  good({{"do", "bus.send"}, {"bus", "dp"}, {"data", "E5"}});
  step(200);
  EXPECT_EQ(detail(to_nobody[0])["answer"], nullptr);
}

// A file of many telegrams comes in parts, and together they are one file: each telegram once, in the order of the line.
TEST_F(OnTrace, PartsOfAFileAreOneFile) {
  constexpr int kSent = 20'500, kAtOnce = 60;  // more than a part has
  for (int n = 0; n < kSent; ++n) {
    // The lowest identifier wins the line: they rise, so that the order is that in which they were sent.
    good({{"do", "bus.send"}, {"bus", "sbus"}, {"identifier", 0x100 + n % kAtOnce}, {"data", fmt::format("{:08X}", n)}});
    if (n % kAtOnce == kAtOnce - 1) step(20);
  }
  step(20);
  for (const char* form : {"candump", "asc", "pcapng"}) {
    std::string bytes;
    size_t parts = 0;
    Json more = Json::object();
    for (Json next = 0; !next.is_null(); ++parts) {
      Json order{{"do", "bus.save"}, {"form", form}, {"bus", "sbus"}, {"after", next}};
      order.update(more);
      const Json reply = good(order);
      bytes += reply.contains("text") ? reply["text"].get<std::string>() : bytes_of_base64(reply["base64"]);
      next = reply["next"];
      more["until"] = reply["until"];
    }
    EXPECT_GE(parts, 2U);
    const Read log = read_all(bytes);
    EXPECT_TRUE(log.wrong.empty()) << form << ": " << log.wrong.front();
    ASSERT_EQ(log.can.size(), static_cast<size_t>(kSent)) << form;
    for (int n = 0; n < kSent; ++n) {
      const auto& data = log.can[static_cast<size_t>(n)].frame.data;
      ASSERT_EQ(data[0] << 24 | data[1] << 16 | data[2] << 8 | data[3], n) << form;
    }
  }
}

}  // namespace
}  // namespace ipos::tests
