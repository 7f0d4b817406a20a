#include "io/write/npz.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "io/full_table.h"
#include "io/read/npz.h"
#include "io/read/result_columns.h"
#include "io/write/output_error.h"
#include "io/write/solution_csv.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

/// In pieces of 7 rows.
void WriteInPieces(const std::string& path, const SolutionTable& table) {
  constexpr std::size_t kPiece = 7;
  const std::vector<SolutionColumn> columns = ColumnsOf(table);
  Npz file(path, columns);
  for (std::size_t k = 0; k < table.size(); k += kPiece) {
    file.Append(RowsOf(table, columns, k, std::min(k + kPiece, table.size())));
  }
  file.Commit();
}

/// What reading the file throws, without its path; "" if it reads.
std::string Refusal(const TemporaryFolder& folder, const std::string& bytes) {
  folder.Write("damaged.npz", bytes);
  try {
    ReadSolutionTable(folder.Path("damaged.npz"));
  } catch (const InputError& error) {
    const std::string text = error.what();
    const std::string path = folder.Path("damaged.npz") + ": ";
    EXPECT_TRUE(text.starts_with(path)) << text;
    return text.substr(path.size());
  }
  return "";
}

TEST(Npz, HoldsEveryBitOfEveryColumn) {
  const TemporaryFolder folder;
  SolutionTable table = FullTable();
  table.separation.assign(table.size(), 0.1);
  table.separation[3] = std::numeric_limits<double>::infinity();
  WriteInPieces(folder.Path("a.npz"), table);
  EXPECT_THAT(folder.Entries(), UnorderedElementsAre("a.npz"));
  const NamedColumns back = ReadNpz(folder.Path("a.npz"));
  const std::vector<SolutionColumn> columns = ColumnsOf(table);
  const Eigen::MatrixXd rows = RowsOf(table, columns, 0, table.size());
  ASSERT_EQ(back.size(), columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::vector<double>& values = back.at(columns[i].name);
    ASSERT_EQ(values.size(), table.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double written =
          rows(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i));
      if (std::isnan(written)) {
        EXPECT_TRUE(std::isnan(values[k])) << columns[i].name;
        EXPECT_EQ(columns[i].name, "separation");
        EXPECT_EQ(k, 3U);
      } else {
        EXPECT_EQ(values[k], written) << columns[i].name;
      }
    }
  }
  EXPECT_EQ(back.at("t"), table.t);
}

TEST(Npz, ReadsAsTheTextDoes) {
  const TemporaryFolder folder;
  SolutionTable table = FullTable();
  table.separation.assign(table.size(),
                          std::numeric_limits<double>::quiet_NaN());
  WriteInPieces(folder.Path("batch.npz"), table);
  WriteSolutionCsv(folder.Path("batch.csv"), table, "hindsight 0", {});
  const SolutionTable text = ReadSolutionTable(folder.Path("batch.csv"));
  const SolutionTable arrays = ReadSolutionTable(folder.Path("batch.npz"));
  EXPECT_EQ(arrays.method, "batch");
  ASSERT_EQ(arrays.t, text.t);
  for (std::size_t k = 0; k < table.size(); ++k) {
    // Up to the last decimals of the text.
    EXPECT_LT((arrays.p_e[k] - text.p_e[k]).norm(), 1e-7);
    EXPECT_LT((arrays.v_e[k] - text.v_e[k]).norm(), 1e-8);
    EXPECT_TRUE(arrays.P_attitude[k].isApprox(text.P_attitude[k], 1e-11));
    // Without these, up to the rounding of geodetic coordinates.
    EXPECT_LT((arrays.p_e[k] - table.p_e[k]).norm(), 1e-8);
    EXPECT_TRUE(arrays.v_e[k].isApprox(table.v_e[k], 1e-14));
    EXPECT_TRUE(arrays.b_g[k].isApprox(table.b_g[k], 1e-15));
  }
  const NumberColumns from_text =
      ReadNumberColumns(folder.Path("batch.csv"), {"cov_"});
  const NumberColumns from_arrays =
      ReadNumberColumns(folder.Path("batch.npz"), {"cov_"});
  ASSERT_EQ(from_arrays.size(), from_text.size());
  for (const auto& [title, values] : from_text) {
    ASSERT_TRUE(from_arrays.contains(title)) << title;
    ASSERT_EQ(from_arrays.at(title).size(), values.size()) << title;
  }
}

TEST(Npz, RefusesWhatIsDamaged) {
  const TemporaryFolder folder;
  WriteInPieces(folder.Path("a.npz"), FullTable());
  const std::string good = folder.Read("a.npz");
  EXPECT_EQ(Refusal(folder, good), "");
  EXPECT_THAT(Refusal(folder, ""), HasSubstr("damaged or cut off"));
  EXPECT_THAT(Refusal(folder, "t[s],lat[deg]\n"), HasSubstr("no archive of"));
  for (const std::size_t size : {good.size() - 1, good.size() / 2}) {
    EXPECT_THAT(Refusal(folder, good.substr(0, size)),
                HasSubstr("damaged or cut off"));
  }
  // The last byte of the first array.
  std::string flipped = good;
  flipped[30 + 5 + 64] ^= 1;
  EXPECT_NE(Refusal(folder, flipped), "");
  EXPECT_THROW(ReadNpz(folder.Path("absent.npz")), InputError);
  // Whatever is changed, it is read or refused in words.
  constexpr std::size_t kStep = 23;
  for (std::size_t at = 0; at < good.size(); at += kStep) {
    std::string changed = good;
    changed[at] = static_cast<char>(changed[at] ^ 0x55);
    Refusal(folder, changed);
  }
}

TEST(Npz, RefusesColumnsThatAreNoTrajectory) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::vector<std::string>& names,
                           const Eigen::MatrixXd& rows) {
    std::vector<SolutionColumn> columns;
    for (const std::string& name : names)
      columns.push_back({name, "1", 1, 1, {}});
    Npz file(folder.Path("b.npz"), columns);
    file.Append(rows);
    file.Commit();
    return Refusal(folder, folder.Read("b.npz"));
  };
  const Eigen::MatrixXd two =
      (Eigen::MatrixXd(2, 2) << 1.0, 0.0, 2.0, 0.0).finished();
  EXPECT_EQ(refusal({"t", "anything"}, two), "");
  EXPECT_THAT(refusal({"time", "anything"}, two), HasSubstr("no column t[s]"));
  EXPECT_THAT(refusal({"t", "lat"}, two),
              HasSubstr("column h[m] is missing beside lat[deg]"));
  EXPECT_THAT(refusal({"t", "t"}, two), HasSubstr("t.npy is there twice"));
  EXPECT_THAT(refusal({"anything", "t"}, two),
              HasSubstr("row 2: time 0 is not after the one before"));
  EXPECT_THAT(refusal({"t", "h"}, Eigen::MatrixXd(0, 2)),
              HasSubstr("is missing beside"));
  EXPECT_THAT(refusal({"t", "a"}, Eigen::MatrixXd(0, 2)),
              HasSubstr("no epoch in the arrays"));
  EXPECT_THAT(refusal({}, Eigen::MatrixXd(0, 0)),
              HasSubstr("is no archive of NumPy arrays"));
  Eigen::MatrixXd four(1, 4);
  four << 1.0, std::nan(""), 2.0, 3.0;
  EXPECT_THAT(refusal({"t", "v_n", "v_e", "v_d"}, four),
              HasSubstr("row 1: v_n[m/s] is not a finite number"));
}

TEST(Npz, NamesTheFileThatCannotBeWritten) {
  const TemporaryFolder folder;
  EXPECT_THROW(Npz(folder.Path("absent/a.npz"), {}), OutputError);
}

}  // namespace
}  // namespace hindsight
