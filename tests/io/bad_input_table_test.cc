#include <fmt/core.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <map>
#include <set>

#include "io/damages.h"
#include "io/recording_folder.h"
#include "io/sample_stream_list.h"

namespace hindsight {
namespace {

/// A case that takes longer hangs [s].
constexpr unsigned kLongest = 20;
char running_case[200];

void DieOfHanging(int) {
  static_cast<void>(!write(STDERR_FILENO, running_case, sizeof(running_case)));
  _exit(3);
}

/// What is read all the same, and why that is right. A stream is named by the
/// beginning of its name.
struct Accepted {
  const char* damage;
  const char* stream;
  const char* reason;
};

constexpr Accepted kAccepted[] = {
    {"byte order mark", "text", "says that the text is UTF-8, as it is"},
    {"mixed line ends", "text", "a line end is one with and without CR"},
    {"gzip", "text", "gzip is read, whatever the name"},
    {"another extension", "", "a format is told by its content or by `format`"},
    {"unknown column", "imu_csv", "csv leaves columns it does not know alone"},
    {"unknown column", "csv", "csv leaves columns it does not know alone"},
    {"a further column everywhere", "plain",
     "files of these formats have columns that are not read"},
    {"a further column everywhere", "pos",
     "RTKLIB writes further columns behind"},
    {"not a number", "csv_dvl_beams", "a beam that is absent is lost"},
    {"an empty value", "csv_dvl_beams", "a beam that is absent is lost"},
    {"an empty value", "nmea",
     "a receiver without a fix leaves its fields empty; `check` counts them"},
    {"without its last column", "csv_speed_course",
     "a course need not be measured"},
    {"without its last column", "gpx",
     "a track need not have heights: it is one without"},
    {"zeros at its end", "mat_imu",
     "numbers of a matrix that is not compressed have no checksum"},
    {"cut within its last number, which another is as short as", "text",
     "a last line needs no line end, and nothing tells this number from a "
     "whole "
     "one"},
    {"a further field", "nmea_position",
     "versions of NMEA differ in their last fields"},
};

class BadInputTable : public RecordingFolder,
                      public ::testing::WithParamInterface<SampleStream> {
 protected:
  void SetUp() override {
    struct sigaction action = {};
    action.sa_handler = DieOfHanging;
    sigaction(SIGALRM, &action, nullptr);
  }
  void TearDown() override { alarm(0); }

  std::string Whole(const std::string& name) const { return Path(name); }

  void WriteAll(const std::string& file) const {
    const SampleStream& stream = GetParam();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    Write("imu.csv", Encode(RestingImu(), RestingImu().table));
    if (stream.encoding == Encoding::kOxts) {
      std::filesystem::create_directories(Path("oxts/data"));
      for (int i = 0; i < kSampleRows; ++i) {
        Write(fmt::format("oxts/data/{:010d}.txt", i), OxtsEpoch());
      }
      Write("oxts/timestamps.txt", Encode(stream, stream.table));
    }
    Write(stream.file, stream.file.find("data/") != std::string::npos
                           ? OxtsEpoch()
                           : Encode(stream, stream.table));
    Write("config.yaml", ConfigOf(stream, file));
  }

  static bool IsAsUndamaged(const std::string& error) {
    const std::string& expected = GetParam().error;
    return expected.empty() ? error.empty()
                            : error.find(expected) != std::string::npos;
  }

  static const char* ReasonToAccept(const Damage& damage) {
    const SampleStream& stream = GetParam();
    for (const Accepted& accepted : kAccepted) {
      const std::string prefix = accepted.stream;
      const bool fits = prefix == "text" ? IsText(stream.encoding)
                                         : stream.name.starts_with(prefix);
      if (damage.name == accepted.damage && fits) return accepted.reason;
    }
    return nullptr;
  }
};

TEST_P(BadInputTable, IsRefusedWithItsPlaceOrListedAsAccepted) {
  const SampleStream& stream = GetParam();
  WriteAll(stream.file);
  ASSERT_TRUE(IsAsUndamaged(LoadError())) << LoadError();
  int refused = 0;
  int accepted = 0;
  for (const Damage& damage : Damages(stream)) {
    SCOPED_TRACE(stream.name + ", " + damage.name);
    std::snprintf(running_case, sizeof(running_case), "hangs: %s, %s\n",
                  stream.name.c_str(), damage.name.c_str());
    WriteAll(damage.file.empty() ? stream.file : damage.file);
    damage.apply(folder_);
    alarm(kLongest);
    std::string error;
    EXPECT_NO_THROW(error = LoadError());
    alarm(0);
    if (const char* reason = ReasonToAccept(damage)) {
      EXPECT_TRUE(IsAsUndamaged(error))
          << error << "\nlisted as accepted: " << reason;
      ++accepted;
      continue;
    }
    EXPECT_NE(error, "") << "is read in silence";
    std::string place = damage.place;
    if (place.empty()) {
      place = stream.file + ":" +
              (damage.line > 0 ? std::to_string(damage.line) + ": " : "");
    }
    const bool named =
        error.find(place) != std::string::npos ||
        // Where there is no file the configuration's line is the place.
        (damage.line == 0 && error.find("config.yaml:") == 0 &&
         error.find(stream.file.substr(0, stream.file.find('/'))) !=
             std::string::npos);
    EXPECT_TRUE(named) << error << "\nexpected " << place;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    ++refused;
  }
  EXPECT_GE(refused + accepted, 36);
  std::printf("%s: %d kinds of damage, %d refused, %d accepted\n",
              stream.name.c_str(), refused + accepted, refused, accepted);
}

/// The types of aiding streams that have no file, so nothing to be damaged.
const std::set<std::string> kWithoutFile = {"non_holonomic"};

TEST_F(RecordingFolder, EveryTypeAndFormatOfTheProgramIsInTheTable) {
  Write("imu.csv", Encode(RestingImu(), RestingImu().table));
  std::string keys;
  for (const SampleStream& stream : SampleStreams()) keys += stream.keys + ",";
  std::replace(keys.begin(), keys.end(), '\n', ',');
  const auto stands = [&](const std::string& words) {
    return keys.find(words + ",") != std::string::npos ||
           keys.find(words + "}") != std::string::npos;
  };
  const SampleStream unknown = {"",
                                Encoding::kCsv,
                                "imu.csv",
                                "aiding:\n  s: {file: FILE, type: zzzz}\n",
                                {}};
  Write("config.yaml", ConfigOf(unknown, "imu.csv"));
  const std::vector<std::string> types = Expected(LoadError());
  EXPECT_GE(types.size(), 11u);
  for (const std::string& type : types) {
    EXPECT_NE(stands("type: " + type), kWithoutFile.contains(type)) << type;
  }
  const std::string text = ConfigOf(unknown, "imu.csv");
  Write("config.yaml", text.substr(0, text.find("aiding")) +
                           "aiding:\n  s: {file: imu.csv, type: position, "
                           "format: zzzz}\n");
  const std::vector<std::string> formats = Expected(LoadError());
  EXPECT_GE(formats.size(), 12u);
  for (const std::string& format : formats) {
    EXPECT_TRUE(format == "csv" || stands("format: " + format)) << format;
  }
}

INSTANTIATE_TEST_SUITE_P(Streams, BadInputTable,
                         ::testing::ValuesIn(SampleStreams()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace hindsight
