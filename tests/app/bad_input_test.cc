#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/recording.h"

namespace hindsight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

constexpr std::size_t kRow = 200;  // damaged data row, counted from 0

/// "imu.csv:LINE:" of the data row `row`.
std::string Place(const std::string& file, std::size_t line) {
  return file + ":" + std::to_string(line) + ":";
}

/// Damages a recording and says which words the one error line must hold.
struct BadInput {
  std::string name;
  std::function<std::vector<std::string>(Recording*)> damage;
};

void PrintTo(const BadInput& row, std::ostream* out) { *out << row.name; }

/// Sets a column of one data row and expects the row to be named.
BadInput BadField(const std::string& name, const std::string& file,
                  std::size_t column, const std::string& value) {
  return {name, [=](Recording* recording) {
            const std::size_t line = recording->FirstRow(file) + 20;
            recording->Edit(file, [&](std::vector<std::string>* lines) {
              SetColumn(&(*lines)[line - 1], column, value);
            });
            return std::vector<std::string>{Place(file, line), value};
          }};
}

/// Changes the rows of a file; `change` gets the lines and the index of one in
/// the middle of the data, whose line must be named.
BadInput BadRows(
    const std::string& name, const std::string& file,
    const std::function<void(std::vector<std::string>*, std::size_t)>& change,
    const std::vector<std::string>& expected) {
  return {name, [=](Recording* recording) {
            const std::size_t line = recording->FirstRow(file) + kRow;
            recording->Edit(file, [&](std::vector<std::string>* lines) {
              change(lines, line - 1);
            });
            std::vector<std::string> words = expected;
            words.push_back(Place(file, line));
            return words;
          }};
}

/// Replaces text of the configuration, whose line must be named.
BadInput BadConfig(const std::string& name, const std::string& from,
                   const std::string& to,
                   const std::vector<std::string>& expected) {
  return {name, [=](Recording* recording) {
            const std::size_t line =
                recording->Replace("config.yaml", from, to) +
                static_cast<std::size_t>(to.front() == '\n');
            std::vector<std::string> words = expected;
            words.push_back(Place("config.yaml", line));
            return words;
          }};
}

std::vector<BadInput> BadInputs() {
  using Text = std::vector<std::string>;
  return {
      {"MissingConfiguration",
       [](Recording* r) -> Text {
         std::filesystem::remove(r->file("config.yaml"));
         return {"data/config.yaml"};
       }},
      {"ColumnsWithoutTheirFormat",
       [](Recording* r) -> Text {
         r->Replace("config.yaml", "  file: imu.csv\n",
                    "  file: imu.csv\n  columns: {t: 1}\n");
         return {"config.yaml:", "imu.columns", "format: csv",
                 "expected beside it `format:` npy or mat or columns"};
       }},
      {"MissingFile",
       [](Recording* r) -> Text {
         std::filesystem::remove(r->file("imu.csv"));
         return {"imu.csv"};
       }},
      {"EmptyFile",
       [](Recording* r) -> Text {
         WriteFile(r->file("imu.csv"), "");
         return {"imu.csv", "empty"};
       }},
      {"HeaderOnly",
       [](Recording* r) -> Text {
         const std::size_t rows = r->FirstRow("imu.csv") - 1;
         r->Edit("imu.csv", [&](Text* lines) { lines->resize(rows); });
         return {"imu.csv"};
       }},
      {"TruncatedLastLine",
       [](Recording* r) -> Text {
         std::string text = ReadFile(r->file("imu.csv"));
         text.resize(text.rfind(',', text.size() - 30));
         WriteFile(r->file("imu.csv"), text);
         return {Place("imu.csv", Lines(text).size()), "truncated"};
       }},
      BadField("NotANumberValue", "imu.csv", 2, "nan"),
      BadField("Infinity", "imu.csv", 4, "inf"),
      BadField("TextInANumber", "imu.csv", 3, "0.1x"),
      BadField("ZeroSigma", "gnss.csv", 4, "0"),
      BadField("NegativeSigma", "gnss.csv", 5, "-0.5"),
      BadRows("TooFewColumns", "imu.csv",
              [](Text* lines, std::size_t i) {
                (*lines)[i].resize((*lines)[i].rfind(','));
              },
              {"7", "6"}),
      BadRows("TooManyColumns", "imu.csv",
              [](Text* lines, std::size_t i) { (*lines)[i] += ",1.0"; },
              {"7", "8"}),
      BadRows("TimeBackwards", "imu.csv",
              [](Text* lines, std::size_t i) {
                std::swap((*lines)[i - 1], (*lines)[i]);
              },
              {"time"}),
      BadRows("DuplicateStamps", "imu.csv",
              [](Text* lines, std::size_t i) {
                lines->insert(lines->begin() + static_cast<long>(i),
                              (*lines)[i - 1]);
              },
              {"duplicate", "on_duplicate"}),
      BadRows("GapInTheImu", "imu.csv",
              [](Text* lines, std::size_t i) {
                lines->erase(lines->begin() + static_cast<long>(i),
                             lines->begin() + static_cast<long>(i) + 200);
              },
              {"gap", "max_gap"}),
      BadConfig("UnknownKey", "max_gap: 0.5 s", "max_gaps: 0.5 s",
                {"max_gaps", "max_gap"}),
      BadConfig("UnknownTopKey", "truth:", "trut:", {"trut", "truth"}),
      BadConfig("MissingUnit", "max_gap: 0.5 s", "max_gap: 0.5",
                {"max_gap", "unit"}),
      BadConfig("WrongUnit", "max_gap: 0.5 s", "max_gap: 0.5 m",
                {"max_gap", "unit"}),
      BadConfig("ZeroSigmaInTheConfiguration", "gyro_bias_sigma: [3 deg/h",
                "gyro_bias_sigma: [0 deg/h", {"gyro_bias_sigma"}),
      BadConfig("NegativeNoise", "gyro: 0.1 deg", "gyro: -0.1 deg",
                {"imu.noise.gyro"}),
      BadConfig("InvalidYaml", "max_gap: 0.5 s", "max_gap: ]", {"YAML"}),
      BadConfig("FileOfAnotherName", "file: imu.csv", "file: imo.csv",
                {"imo.csv"}),
      {"NoOverlap",
       [](Recording* r) -> Text {
         const std::size_t first = r->FirstRow("gnss.csv") - 1;
         r->Edit("gnss.csv", [&](Text* lines) {
           for (std::size_t i = first; i < lines->size(); ++i) {
             (*lines)[i].insert(0, "90000");
           }
         });
         return {"gnss", "overlap"};
       }},
      {"DamagedGzip",
       [](Recording* r) -> Text {
         WriteGzip(r->file("imu.csv.gz"), ReadFile(r->file("imu.csv")));
         std::string packed = ReadFile(r->file("imu.csv.gz"));
         packed[packed.size() / 2] =
             static_cast<char>(~packed[packed.size() / 2]);
         WriteFile(r->file("imu.csv.gz"), packed);
         r->Replace("config.yaml", "imu.csv", "imu.csv.gz");
         return {"imu.csv.gz"};
       }},
      {"CutOffGzip",
       [](Recording* r) -> Text {
         WriteGzip(r->file("imu.csv.gz"), ReadFile(r->file("imu.csv")));
         std::string packed = ReadFile(r->file("imu.csv.gz"));
         packed.resize(packed.size() / 2);
         WriteFile(r->file("imu.csv.gz"), packed);
         r->Replace("config.yaml", "imu.csv", "imu.csv.gz");
         return {"imu.csv.gz"};
       }},
  };
}

class BadInputTest : public ::testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, EndsWithTwoAndOneLineThatSaysWhere) {
  Recording recording;
  const std::vector<std::string> expected = GetParam().damage(&recording);
  const Outcome outcome = recording.Run({"--out=out", "--methods=ekf"});
  EXPECT_EQ(outcome.status, 2);
  ASSERT_THAT(Lines(outcome.err), SizeIs(1)) << outcome.err;
  EXPECT_THAT(outcome.err, StartsWith("hindsight: error: "));
  for (const std::string& words : expected) {
    EXPECT_THAT(outcome.err, HasSubstr(words));
  }
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(Names(recording.root()), ElementsAre("data"));
}

INSTANTIATE_TEST_SUITE_P(Table, BadInputTest, ::testing::ValuesIn(BadInputs()),
                         [](const auto& info) { return info.param.name; });

/// Folders that cannot be made: a parent that is absent, a file, or read-only
/// even to the superuser.
TEST(OutputFolder, ThatCannotBeWrittenEndsWithTwoBeforeAnyWork) {
  Recording recording;
  // Were the data read first, this would be the error.
  std::filesystem::remove(recording.file("imu.csv"));
  for (const std::string out :
       {"absent/out", "data/config.yaml/out", "/proc/out"}) {
    const Outcome outcome = recording.Run({"--out=" + out});
    EXPECT_EQ(outcome.status, 2);
    ASSERT_THAT(Lines(outcome.err), SizeIs(1)) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("cannot be written"));
    EXPECT_THAT(outcome.err, HasSubstr(out));
    EXPECT_THAT(Names(recording.root()), ElementsAre("data"));
  }
}

TEST(GoodInput, CarriageReturnsByteOrderMarkAndGzipAreSimplyRead) {
  Recording recording;
  ASSERT_EQ(recording.Run({"--out=plain", "--methods=ekf"}).status, 0);
  for (const std::string file : {"imu.csv", "config.yaml", "gnss.csv"}) {
    std::string text = "\xEF\xBB\xBF";
    for (const std::string& line : Lines(ReadFile(recording.file(file)))) {
      text += line + "\r\n";
    }
    WriteFile(recording.file(file), text);
  }
  WriteGzip(recording.file("imu.csv.gz"), ReadFile(recording.file("imu.csv")));
  std::filesystem::remove(recording.file("imu.csv"));
  recording.Replace("config.yaml", "imu.csv", "imu.csv.gz");
  const Outcome outcome = recording.Run({"--out=out", "--methods=ekf"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(ReadFile(recording.root() / "out" / "ekf.csv"),
            ReadFile(recording.root() / "plain" / "ekf.csv"));
}

}  // namespace
}  // namespace hindsight
