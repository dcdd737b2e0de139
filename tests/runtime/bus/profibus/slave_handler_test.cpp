// What a master asks a slave next, answer by answer (EN 50170 volume 2, DP: start-up and data exchange of the class 1
// master), with the frame count bit of each request.
#include "runtime/bus/profibus/slave_handler.hpp"

#include "tests/runtime/bus/profibus/octets.hpp"

namespace ipos::tests {
namespace {

SlavePlan two_octets() { return {8, *decode_prm(hex("B0 00 00 0B 31 00 00")), hex("F0"), 2, 2}; }

// The request in octets without SD2 and check: "88 82 6D 3C 3E".
std::string asks(SlaveHandler& handler) {
  const auto frame = handler.request();
  if (!frame) return "nothing";
  const Octets octets = encode(*frame);
  return frame->kind == Delimiter::SD1 ? text_of(std::span(octets).subspan(1, 3))
                                       : text_of(std::span(octets).subspan(4, octets.size() - 6));
}
FdlFrame diagnosis(const std::string& octets) { return make_frame(2, 8, 0x08, 62, 60, hex(octets)); }
FdlFrame data(const std::string& octets, uint8_t control = 0x08) {
  return make_frame(2, 8, control, {}, {}, hex(octets));
}
const FdlFrame kNoService = make_frame(2, 8, 0x03);
const std::string kReady = "00 04 00 02 31 00";

// Diagnosis, parameters, configuration, diagnosis, data.
SlaveHandler exchanging() {
  SlaveHandler handler(2, two_octets());
  for (const FdlFrame& answer :
       {diagnosis("02 05 00 FF 31 00"), make_acknowledgement(), make_acknowledgement(), diagnosis(kReady)}) {
    handler.request();
    handler.answered(answer);
  }
  EXPECT_EQ(handler.state(), HandlerState::Exchange);
  return handler;
}

TEST(SlaveHandler, StartUpWithItsFrameCountBits) {
  SlaveHandler handler(2, two_octets());
  EXPECT_EQ(handler.view().status[0], 0x01) << "nothing was heard of it";
  EXPECT_EQ(asks(handler), "88 82 6D 3C 3E") << "FCB 1 and not valid: the first one";
  EXPECT_EQ(asks(handler), "88 82 6D 3C 3E") << "the same again";
  handler.answered(diagnosis("02 05 00 FF 31 00"));
  EXPECT_EQ(handler.view().status[0], 0x02);
  EXPECT_EQ(asks(handler), "88 82 5D 3D 3E B0 00 00 0B 31 00 00");
  handler.answered(make_acknowledgement());
  EXPECT_EQ(asks(handler), "88 82 7D 3E 3E F0");
  handler.answered(make_acknowledgement());
  EXPECT_EQ(asks(handler), "88 82 5D 3C 3E");
  EXPECT_FALSE(handler.exchanging());
  handler.answered(diagnosis(kReady));
  EXPECT_TRUE(handler.exchanging());
  EXPECT_EQ(asks(handler), "08 02 7D 00 00") << "outputs are 0 at first";
  handler.set_outputs(hex("12 34"));
  EXPECT_EQ(asks(handler), "08 02 7D 12 34");
  handler.answered(data("AB CD"));
  EXPECT_EQ(text_of(handler.inputs()), "AB CD");
  EXPECT_EQ(handler.exchanges(), 1U);
  EXPECT_EQ(asks(handler), "08 02 5D 12 34");
  // Whoever does not answer is asked for diagnosis, with a first frame count bit.
  handler.unanswered();
  EXPECT_EQ(handler.view().status[0] & 1, 1);
  EXPECT_EQ(asks(handler), "88 82 6D 3C 3E");
  EXPECT_EQ(text_of(handler.inputs()), "AB CD");
}

// What a diagnosis means in each state: another master's slave is left alone, and faults begin anew.
TEST(SlaveHandler, EveryDiagnosisInEveryState) {
  struct Row {
    const char* octets;
    HandlerState first, second, exchange;
    bool again;  // diagnosis is asked for once more in data exchange
  };
  using enum HandlerState;
  const Row rows[] = {{"00 04 00 02 31 00", Prm, Exchange, Exchange, false},
                      {"00 04 00 FF 31 00", Prm, Exchange, Exchange, false},
                      {"00 04 00 05 31 00", FirstDiag, Exchange, Exchange, false},
                      {"02 04 00 02 31 00", Prm, SecondDiag, FirstDiag, true},  // not ready
                      {"00 06 00 02 31 00", Prm, SecondDiag, Exchange, true},   // static diagnosis
                      {"40 04 00 02 31 00", Prm, FirstDiag, FirstDiag, true},   // parameters
                      {"04 04 00 02 31 00", Prm, FirstDiag, FirstDiag, true},   // configuration
                      {"00 05 00 02 31 00", Prm, FirstDiag, FirstDiag, true},   // wants parameters
                      {"08 04 00 02 31 00 02 2F", Prm, Exchange, Exchange, false}};
  for (const Row& row : rows) {
    SlaveHandler first(2, two_octets());
    first.request();
    first.answered(diagnosis(row.octets));
    EXPECT_EQ(first.state(), row.first) << row.octets;
    const bool foreign = hex(row.octets)[3] == 5;
    EXPECT_EQ(first.view().has(diag::kMasterLock), foreign) << row.octets;
    SlaveHandler second(2, two_octets());
    for (const FdlFrame& answer : {diagnosis("02 05 00 FF 31 00"), make_acknowledgement(),
                                   make_acknowledgement(), diagnosis(row.octets)}) {
      second.request();
      second.answered(answer);
    }
    EXPECT_EQ(second.state(), row.second) << row.octets;
    SlaveHandler exchange = exchanging();
    exchange.request();
    exchange.answered(data("00 00", 0x0A));  // diagnosis waits
    EXPECT_EQ(asks(exchange).substr(0, 5), "88 82") << "it is fetched at once";
    exchange.answered(diagnosis(row.octets));
    EXPECT_EQ(exchange.state(), row.exchange) << row.octets;
    EXPECT_EQ(asks(exchange).substr(0, 5) == "88 82", row.again) << row.octets;
  }
}

TEST(SlaveHandler, AnswersThatAreNoGood) {
  // In place of an acknowledgement.
  for (const int acknowledged : {0, 1}) {
    SlaveHandler handler(2, two_octets());
    handler.request();
    handler.answered(diagnosis("02 05 00 FF 31 00"));
    for (int n = 0; n < acknowledged; ++n) {
      handler.request();
      handler.answered(make_acknowledgement());
    }
    EXPECT_EQ(handler.state(), acknowledged == 0 ? HandlerState::Prm : HandlerState::Cfg);
    handler.request();
    handler.answered(kNoService);
    EXPECT_EQ(handler.state(), HandlerState::FirstDiag);
  }
  // In place of data: another length, another function, and no service, which says nothing against the answer.
  struct Row {
    FdlFrame answer;
    bool good, invalid;
  };
  for (const Row& row :
       {Row{data("01 02"), true, false}, Row{data("01 02", 0x0A), true, false}, Row{data("01"), false, true},
        Row{data("01 02 03"), false, true}, Row{data("01 02", 0x0C), false, true},
        Row{kNoService, false, false}, Row{make_acknowledgement(), false, true}}) {
    SlaveHandler handler = exchanging();
    handler.request();
    handler.garbled();
    EXPECT_TRUE(handler.view().has(diag::kInvalidResponse));
    handler.answered(row.answer);
    EXPECT_EQ(handler.state(), row.good ? HandlerState::Exchange : HandlerState::FirstDiag);
    EXPECT_EQ(handler.view().has(diag::kInvalidResponse), row.invalid);
    EXPECT_EQ(handler.exchanges(), row.good ? 1U : 0U);
    EXPECT_EQ(text_of(handler.inputs()), row.good ? "01 02" : "00 00");
  }
  // In place of a diagnosis.
  SlaveHandler handler = exchanging();
  handler.unanswered();
  handler.request();
  handler.answered(diagnosis("00 04 00 02 31"));
  EXPECT_EQ(handler.state(), HandlerState::FirstDiag);
  EXPECT_TRUE(handler.view().has(diag::kInvalidResponse));
  EXPECT_FALSE(handler.view().has(diag::kNonExistent));
}

TEST(SlaveHandler, TakenOutOfTheCycle) {
  SlaveHandler handler = exchanging();
  handler.set_active(false);
  EXPECT_EQ(asks(handler), "nothing");
  EXPECT_TRUE(handler.view().has(diag::kDeactivated));
  EXPECT_FALSE(handler.exchanging());
  handler.set_active(true);
  EXPECT_FALSE(handler.view().has(diag::kDeactivated));
  EXPECT_EQ(asks(handler).substr(0, 5), "88 82") << "from the beginning";
}

}  // namespace
}  // namespace ipos::tests
