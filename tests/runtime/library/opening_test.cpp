// Opening, stations, orders, and the state as bytes: what a plant is made of, what is refused, and that a state that is
// restored goes on as the one that was saved.
#include "stdlib/unit_types.hpp"
#include "tests/runtime/library/opened_plant.hpp"
#include "vm/image/image.hpp"

namespace ipos::tests {
namespace {

ipos_plant_status open_with(const ipos_plant_source& source, std::string& first_mistake) {
  ipos_plant* plant = nullptr;
  const ipos_plant_status status = ipos_plant_open(&source, &plant);
  ipos_plant_mistake mistake{};
  first_mistake.clear();
  if (ipos_plant_mistake_at(plant, 0, &mistake) == IPOS_PLANT_OK)
    first_mistake = std::to_string(mistake.line) + ": " + mistake.text;
  EXPECT_EQ(plant != nullptr, status != IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
  return status;
}

TEST(LibraryOpening, WhatIsAskedForMustMakeSense) {
  std::string ignored;
  const char* const text = "[[station]]\nname = \"a\"\nunit = \"mdxb\"\n";
  const char* const good[] = {"."};
  const char* const bad[] = {".", nullptr};
  ipos_plant_source source{};
  source.text = text;
  source.commands_a_ms = 1'000'000;
  source.flags = IPOS_PLANT_NO_RECORD | IPOS_PLANT_WRITE_MEMORY;
  source.include_dirs = source.defines = good;
  source.include_dir_count = source.define_count = 1;
  EXPECT_EQ(open_with(source, ignored), IPOS_PLANT_OK);
  const auto refused = [&](const auto& change) {
    ipos_plant_source wrong = source;
    change(wrong);
    EXPECT_EQ(open_with(wrong, ignored), IPOS_PLANT_INVALID_ARGUMENT);
  };
  refused([](auto& wrong) { wrong.commands_a_ms = 1'000'001; });
  refused([](auto& wrong) { wrong.flags = 4; });
  refused([](auto& wrong) { wrong.text = nullptr; });
  refused([](auto& wrong) { wrong.include_dirs = nullptr; });
  refused([](auto& wrong) { wrong.defines = nullptr; });
  refused([&](auto& wrong) { wrong.include_dirs = bad, wrong.include_dir_count = 2; });
  refused([&](auto& wrong) { wrong.defines = bad, wrong.define_count = 2; });
  EXPECT_EQ(ipos_plant_open(&source, nullptr), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_mistakes(nullptr), 0U);
}

TEST(LibraryOpening, MistakesOfProgramsStandAtTheirPlace) {
  const OwnFolder folder;
  const std::string path = folder.path();
  const auto mistake = [&](const std::string& unit, const std::string& program) {
    const std::string text =
        "[[station]]\nname = \"a\"\nunit = \"" + unit + "\"\nprogram = \"" + program + "\"\n";
    ipos_plant_source source{};
    source.text = text.c_str();
    source.folder = path.c_str();
    std::string first;
    const ipos_plant_status status = open_with(source, first);
    EXPECT_EQ(status, first.empty() ? IPOS_PLANT_OK : IPOS_PLANT_BAD_PLANT);
    return first;
  };
  folder.write("GOOD.IPC", "main() { }\n");
  folder.write("BAD.ipc", "main()\n{ x = 1; }\n");
  folder.write("NONE.IPX", "no image");
  EXPECT_EQ(mistake("mdxb", "GOOD.IPC"), "");
  EXPECT_TRUE(mistake("mdxb", "BAD.ipc").starts_with("2: ")) << mistake("mdxb", "BAD.ipc");
  EXPECT_EQ(mistake("mdxb", "MISSING.IPC"),
            "4: station 'a': program " + folder.path("MISSING.IPC") + ": there is no such file");
  EXPECT_EQ(mistake("mdxb", "."), "4: station 'a': program " + path + ": is no file");
  EXPECT_TRUE(mistake("mdxb", "NONE.IPX")
                  .starts_with("4: station 'a': image " + folder.path("NONE.IPX") + " refused at byte "));
  // An image names the unit it was made for: one that there is not, one without programs, another one.
  const auto of_unit = [&](uint8_t unit) {
    vm::Image image;
    image.unit = unit;
    const std::vector<uint8_t> bytes = vm::write_image(image);
    folder.write("ODD.IPX", std::string(bytes.begin(), bytes.end()));
    return mistake("mdxb", "ODD.IPX");
  };
  const auto code_of = [](std::string_view name) { return stdlib::find_unit(name)->code; };
  const std::string odd = "4: station 'a': " + folder.path("ODD.IPX");
  EXPECT_EQ(of_unit(200), odd + " is for a unit that runs no program");
  EXPECT_EQ(of_unit(code_of("mc31")), odd + " is for a unit that runs no program");
  EXPECT_EQ(of_unit(code_of("mc07")), odd + " is for unit mc07, the station is mdxb");
}

TEST(LibraryOpening, IncludesAndDefinesReachTheCompiler) {
  const OwnFolder more;
  more.write("own.h", "#define BEGIN 40\n");
  const std::string folder = more.path();
  const char* const folders[] = {folder.c_str()};
  const char* const defines[] = {"MORE=2", "NOTHING"};
  ipos_plant_source source{};
  source.include_dirs = folders;
  source.include_dir_count = 1;
  source.defines = defines;
  source.define_count = 2;
  const OpenedPlant plant("[[station]]\nname = \"a\"\nunit = \"mdxb\"\nprogram = \"P.IPC\"\n",
                          "#include <own.h>\nlong n;\n#ifdef NOTHING\nmain() { n = BEGIN + MORE; }\n#endif\n",
                          source);
  plant.run(10);
  EXPECT_EQ(plant.value(plant.find("n")), 42);
}

// A program alone is a plant of one station that is called like it.
TEST(LibraryOpening, AProgramAloneIsAPlant) {
  const OwnFolder folder;
  folder.write("SAW.IPC",
               "#include <constb.h>\n#include <iob.h>\nlong n;\nmain() { n = 5; while (1) n = n + 1; }\n");
  const std::string path = folder.path("SAW.IPC");
  for (const uint32_t commands : {1U, 10U}) {
    ipos_plant_source source{};
    source.path = path.c_str();
    source.commands_a_ms = commands;
    ipos_plant* plant = nullptr;
    ASSERT_EQ(ipos_plant_open(&source, &plant), IPOS_PLANT_OK) << ipos_plant_message(plant);
    ipos_plant_station_info info{};
    ASSERT_EQ(ipos_plant_station_at(plant, 0, &info), IPOS_PLANT_OK);
    EXPECT_STREQ(info.name, "SAW");
    EXPECT_STREQ(info.program, "SAW.IPC");
    EXPECT_STREQ(info.unit, "mdxb");
    uint32_t n = 0;
    int64_t value = 0;
    EXPECT_EQ(ipos_plant_find(plant, 0, IPOS_PLANT_VARIABLE, "n", &n), IPOS_PLANT_OK);
    EXPECT_EQ(ipos_plant_run(plant, 100'000'000), IPOS_PLANT_OK);
    EXPECT_EQ(ipos_plant_read(plant, n, &value), IPOS_PLANT_OK);
    EXPECT_EQ(value > 150, commands == 10) << "a turn has two commands at least";
    EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
  }
  ipos_plant_source source{};
  const std::string missing = folder.path("MISSING.toml");
  source.path = missing.c_str();
  std::string first;
  EXPECT_EQ(open_with(source, first), IPOS_PLANT_BAD_PLANT);
  EXPECT_EQ(first, "0: there is no such file");
}

// Relative to the folder; without the flag nothing is written.
TEST(LibraryOpening, MemoryFilesStandBesideThePlant) {
  const OwnFolder folder;
  const std::string path = folder.path();
  for (const bool writes : {false, true}) {
    ipos_plant_source source{};
    source.text =
        "[[station]]\nname = \"a\"\nunit = \"mdxb\"\nnvram = \"a.nv\"\n[[station]]\nname = \"b\"\nunit = "
        "\"mdxb\"\n";
    source.folder = path.c_str();
    source.flags = writes ? uint32_t{IPOS_PLANT_WRITE_MEMORY} : 0U;
    ipos_plant* plant = nullptr;
    ASSERT_EQ(ipos_plant_open(&source, &plant), IPOS_PLANT_OK) << ipos_plant_message(plant);
    EXPECT_EQ(ipos_plant_run(plant, 10'000'000), IPOS_PLANT_OK);
    EXPECT_EQ(ipos_plant_restart(plant), writes ? IPOS_PLANT_REFUSED : IPOS_PLANT_OK);
    EXPECT_EQ(ipos_plant_close(plant), IPOS_PLANT_OK);
    EXPECT_EQ(std::filesystem::exists(folder.path("a.nv")), writes);
  }
}

constexpr const char* kTwoDrives = R"([[bus]]
name = "can"
kind = "can"
[[station]]
name = "a"
unit = "mdxb"
program = "P.IPC"
sbus = "can"
[[station]]
name = "b"
unit = "mc07"
)";
constexpr const char* kGoesOn = "long n;\nmain() { while (1) n = n + 1; }\n";

TEST(LibraryStations, HaveNumbersAndTakeOrders) {
  const OpenedPlant plant(kTwoDrives, kGoesOn);
  plant.run(20);
  uint32_t number = 9;
  EXPECT_EQ(ipos_plant_station(plant.plant, "b", &number), IPOS_PLANT_OK);
  EXPECT_EQ(number, 1U);
  ipos_plant_station_info info{};
  EXPECT_EQ(ipos_plant_station_at(plant.plant, 1, &info), IPOS_PLANT_OK);
  EXPECT_STREQ(info.name, "b");
  EXPECT_STREQ(info.program, "");
  EXPECT_EQ(ipos_plant_station_at(plant.plant, 2, &info), IPOS_PLANT_NO_STATION);
  EXPECT_EQ(plant.message(), "there is no station number 2");
  for (const auto& order : {ipos_plant_reset_fault}) EXPECT_EQ(order(plant.plant, 2), IPOS_PLANT_NO_STATION);
  EXPECT_EQ(ipos_plant_power(plant.plant, 2, true), IPOS_PLANT_NO_STATION);
  bool ideal = false;
  EXPECT_EQ(ipos_plant_ideal_motor(plant.plant, 1, &ideal), IPOS_PLANT_OK);
  EXPECT_TRUE(ideal);
  EXPECT_EQ(ipos_plant_ideal_motor(plant.plant, 2, &ideal), IPOS_PLANT_NO_STATION);
  EXPECT_EQ(ipos_plant_ideal_motor(plant.plant, 0, nullptr), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_drive_fault(plant.plant, 0, 0), IPOS_PLANT_INVALID_ARGUMENT);
  for (const int32_t wrong : {-1, 3})
    EXPECT_EQ(ipos_plant_program(plant.plant, 0, wrong), IPOS_PLANT_INVALID_ARGUMENT);

  const uint32_t running = plant.find("running"), fault = plant.find("fault"),
                 powered = plant.find("powered");
  EXPECT_EQ(ipos_plant_program(plant.plant, 0, IPOS_PLANT_PROGRAM_START), IPOS_PLANT_REFUSED);
  EXPECT_EQ(plant.message(), "the program runs already");
  EXPECT_EQ(ipos_plant_program(plant.plant, 0, IPOS_PLANT_PROGRAM_STOP), IPOS_PLANT_OK);
  EXPECT_EQ(plant.value(running), 0);
  EXPECT_EQ(ipos_plant_program(plant.plant, 0, IPOS_PLANT_PROGRAM_START), IPOS_PLANT_OK);
  EXPECT_EQ(plant.value(running), 1);
  EXPECT_EQ(ipos_plant_program(plant.plant, 0, IPOS_PLANT_PROGRAM_RESTART), IPOS_PLANT_OK);
  for (const int number_of_fault : {1, 26, 255}) {
    EXPECT_EQ(ipos_plant_drive_fault(plant.plant, 0, static_cast<uint8_t>(number_of_fault)), IPOS_PLANT_OK);
    EXPECT_EQ(plant.value(fault), number_of_fault);
    int64_t now = 0;
    ipos_plant_time(plant.plant, &now);
    plant.run(now / 1'000'000 + 300);
    EXPECT_EQ(ipos_plant_reset_fault(plant.plant, 0), IPOS_PLANT_OK);
    plant.run(now / 1'000'000 + 600);
    EXPECT_EQ(plant.value(fault), 0);
  }
  const char* why = "";
  EXPECT_EQ(ipos_plant_why(plant.plant, 0, &why), IPOS_PLANT_OK);
  EXPECT_STRNE(why, "the power is off");
  EXPECT_EQ(ipos_plant_power(plant.plant, 0, false), IPOS_PLANT_OK);
  EXPECT_EQ(plant.value(powered), 0);
  EXPECT_EQ(ipos_plant_why(plant.plant, 0, &why), IPOS_PLANT_OK);
  EXPECT_STREQ(why, "the power is off");
  EXPECT_EQ(ipos_plant_why(plant.plant, 2, &why), IPOS_PLANT_NO_STATION);
  EXPECT_EQ(ipos_plant_power(plant.plant, 0, true), IPOS_PLANT_OK);
  EXPECT_EQ(plant.value(powered), 1);
}

TEST(LibraryTime, ConditionsAreAskedBeforeAndAtEveryMillisecond) {
  const OpenedPlant plant("[[station]]\nname = \"a\"\nunit = \"mdxb\"\n");
  struct Asked {
    int64_t last = 0;
    std::vector<int64_t> times;
  } asked;
  const auto condition = [](void* user, ipos_plant* of) {
    auto& all = *static_cast<Asked*>(user);
    ipos_plant_time(of, &all.times.emplace_back());
    return all.times.back() >= all.last;
  };
  asked.last = 2'000'000;
  EXPECT_EQ(ipos_plant_run_until(plant.plant, 9'000'000, condition, &asked), IPOS_PLANT_OK);
  EXPECT_EQ(asked.times, (std::vector<int64_t>{0, 1'000'000, 2'000'000}));
  asked.times.clear();
  EXPECT_EQ(ipos_plant_run_until(plant.plant, 9'000'000, condition, &asked), IPOS_PLANT_OK);
  EXPECT_EQ(asked.times, std::vector<int64_t>{2'000'000}) << "it holds already";
  asked.last = INT64_MAX;
  EXPECT_EQ(ipos_plant_run_until(plant.plant, 4'000'000, condition, &asked), IPOS_PLANT_NOT_REACHED);
  EXPECT_EQ(plant.message(), "the time limit came before the condition");
  EXPECT_EQ(ipos_plant_run_until(plant.plant, 3'999'999, condition, &asked), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_run_until(plant.plant, 5'000'000, nullptr, &asked), IPOS_PLANT_INVALID_ARGUMENT);
  for (const int64_t wrong : {int64_t{3'999'999}, int64_t{INT64_MAX}}) {
    EXPECT_EQ(ipos_plant_run(plant.plant, wrong), IPOS_PLANT_INVALID_ARGUMENT);
    EXPECT_EQ(plant.message(), "it is 4000000 ns: time does not run back");
  }
  EXPECT_EQ(ipos_plant_run(plant.plant, 4'000'000), IPOS_PLANT_OK);
}

std::string saved_state(const OpenedPlant& plant) {
  size_t size = 0;
  EXPECT_EQ(ipos_plant_save(plant.plant, nullptr, &size), IPOS_PLANT_TOO_SMALL);
  std::string bytes(size, 0);
  EXPECT_EQ(ipos_plant_save(plant.plant, bytes.data(), &size), IPOS_PLANT_OK);
  return bytes;
}

uint64_t hash_of(const OpenedPlant& plant) {
  uint64_t hash = 0;
  EXPECT_EQ(ipos_plant_trace_hash(plant.plant, &hash), IPOS_PLANT_OK);
  return hash;
}

TEST(LibraryStates, GoOnAsTheOneThatWasSaved) {
  const OpenedPlant plant(kTwoDrives, kGoesOn);
  const uint32_t n = plant.find("n"), input = plant.find("DI05"), line = plant.find("task1.line");
  ipos_plant_frame frame{};
  frame.id = 0x123;
  uint32_t first = 0, second = 0;
  plant.run(5);
  EXPECT_EQ(ipos_plant_write(plant.plant, input, 1), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_send(plant.plant, 0, &frame, &first), IPOS_PLANT_OK);
  plant.run(20);
  const std::string saved = saved_state(plant);
  const int64_t counted = plant.value(n);
  const uint64_t hash = hash_of(plant);
  EXPECT_EQ(hash_of(plant), hash);
  EXPECT_EQ(ipos_plant_write(plant.plant, input, 0), IPOS_PLANT_OK);
  plant.run(40);
  EXPECT_NE(plant.value(n), counted);
  EXPECT_NE(hash_of(plant), hash);
  EXPECT_EQ(ipos_plant_restore(plant.plant, saved.data(), saved.size()), IPOS_PLANT_OK) << plant.message();
  EXPECT_EQ(plant.value(n), counted);
  EXPECT_EQ(plant.value(input), 1);
  EXPECT_EQ(plant.value(line), 2) << "a reader looks into the plant of now";
  EXPECT_EQ(hash_of(plant), hash);
  EXPECT_EQ(saved_state(plant), saved);
  EXPECT_EQ(ipos_plant_send(plant.plant, 0, &frame, &second), IPOS_PLANT_OK);
  EXPECT_EQ(second, first + 1) << "tags go on";
  // Somebody else does the same with the same plant.
  const OpenedPlant other(kTwoDrives, kGoesOn);
  other.run(5);
  EXPECT_EQ(ipos_plant_write(other.plant, other.find("DI05"), 1), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_send(other.plant, 0, &frame, nullptr), IPOS_PLANT_OK);
  other.run(20);
  EXPECT_EQ(hash_of(other), hash);
  EXPECT_EQ(saved_state(other), saved);
  const OpenedPlant changed(kTwoDrives, "long n;\nmain() { while (1) n = n + 2; }\n");
  EXPECT_EQ(ipos_plant_restore(changed.plant, saved.data(), saved.size()), IPOS_PLANT_OTHER_PLANT);
}

// Open once, run many: each run is that of a plant that was just opened, whatever the one before was.
TEST(LibraryStates, ARestartIsANewPlant) {
  const auto run = [](const OpenedPlant& plant, int level) {
    EXPECT_EQ(ipos_plant_write(plant.plant, plant.find("DI05"), level), IPOS_PLANT_OK);
    plant.run(30);
    return hash_of(plant);
  };
  const OpenedPlant plant(kTwoDrives, kGoesOn);
  const uint32_t n = plant.find("n");
  const uint64_t low = run(plant, 0);
  const int64_t counted = plant.value(n);
  EXPECT_EQ(ipos_plant_drive_fault(plant.plant, 0, 26), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_power(plant.plant, 1, false), IPOS_PLANT_OK);
  plant.run(40);
  EXPECT_EQ(ipos_plant_restart(plant.plant), IPOS_PLANT_OK) << plant.message();
  int64_t now = -1;
  EXPECT_EQ(ipos_plant_time(plant.plant, &now), IPOS_PLANT_OK);
  EXPECT_EQ(now, 0);
  EXPECT_EQ(plant.value(n), 0) << "a signal keeps its number and reads the plant of now";
  const uint64_t high = run(plant, 1);
  EXPECT_NE(high, low);
  EXPECT_EQ(ipos_plant_restart(plant.plant), IPOS_PLANT_OK);
  EXPECT_EQ(run(plant, 0), low);
  EXPECT_EQ(plant.value(n), counted);
  EXPECT_EQ(run(OpenedPlant(kTwoDrives, kGoesOn), 1), high);
}

TEST(LibraryStates, TagsBeginAgainWithTheState) {
  const OpenedPlant plant(kTwoDrives, kGoesOn);
  const std::string fresh = saved_state(plant);
  ipos_plant_frame frame{};
  uint32_t first = 0, second = 0, again = 0;
  EXPECT_EQ(ipos_plant_send(plant.plant, 0, &frame, &first), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_send(plant.plant, 0, &frame, &second), IPOS_PLANT_OK);
  EXPECT_NE(first, second);
  EXPECT_EQ(ipos_plant_restore(plant.plant, fresh.data(), fresh.size()), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_send(plant.plant, 0, &frame, &again), IPOS_PLANT_OK);
  EXPECT_EQ(again, first);
}

TEST(LibraryStates, AReplayLooksAtEveryMillisecond) {
  const OpenedPlant plant("[[station]]\nname = \"a\"\nunit = \"mdxb\"\n");
  plant.run(3);
  EXPECT_EQ(ipos_plant_write(plant.plant, plant.find("DI05"), 1), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_run(plant.plant, 5'500'000), IPOS_PLANT_OK);
  std::vector<int64_t> times;
  const auto look = [](void* user, ipos_plant* of) {
    ipos_plant_time(of, &static_cast<std::vector<int64_t>*>(user)->emplace_back());
    return ipos_plant_run(of, 99'000'000) == IPOS_PLANT_BUSY;
  };
  EXPECT_EQ(ipos_plant_replay(plant.plant, look, &times), IPOS_PLANT_OK);
  EXPECT_EQ(times, (std::vector<int64_t>{0, 1'000'000, 2'000'000, 3'000'000, 4'000'000, 5'000'000}));
  EXPECT_EQ(plant.value(plant.find("DI05")), 1);
  EXPECT_EQ(ipos_plant_replay(plant.plant, nullptr, nullptr), IPOS_PLANT_INVALID_ARGUMENT);
}

TEST(LibraryJournal, HasWhatWasTold) {
  const OpenedPlant plant("[[station]]\nname = \"a\"\nunit = \"mdxb\"\n");
  plant.run(3);
  EXPECT_EQ(ipos_plant_power(plant.plant, 0, false), IPOS_PLANT_OK);
  ipos_plant_entry entry{};
  size_t number = 0;
  bool found = false;
  while (ipos_plant_journal_at(plant.plant, number, &entry) == IPOS_PLANT_OK) {
    if (std::string(entry.text) == "the power is switched off") {
      found = true;
      EXPECT_EQ(std::tuple(entry.time, entry.weight, std::string(entry.station)),
                std::tuple(3'000'000, ipos_plant_weight{IPOS_PLANT_WHY}, "a"));
    }
    ++number;
  }
  EXPECT_TRUE(found);
  EXPECT_EQ(ipos_plant_journal_at(plant.plant, number, &entry), IPOS_PLANT_NOTHING);
  EXPECT_EQ(ipos_plant_journal_at(plant.plant, 0, nullptr), IPOS_PLANT_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace ipos::tests
