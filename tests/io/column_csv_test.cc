#include "io/write/column_csv.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace hindsight {
namespace {

/// As many columns of three decimals, six digits and all digits in turn.
std::vector<SolutionColumn> SomeColumns(int count) {
  std::vector<SolutionColumn> columns;
  for (int i = 0; i < count; ++i) {
    const int digits[] = {3, -6, 0};
    columns.push_back(
        {"c" + std::to_string(i), "m", 1.0, digits[i % 3], std::nullopt});
  }
  return columns;
}

TEST(ColumnCsv, HasAllFieldsOfALineOfAnyLength) {
  const TemporaryFolder folder;
  constexpr int kColumns = 300;
  const std::vector<SolutionColumn> columns = SomeColumns(kColumns);
  // Numbers of one digit and of 300, and what is not there.
  Eigen::MatrixXd rows(4, kColumns);
  rows.row(0).setConstant(2.0);
  rows.row(1).setConstant(-1.25e300);
  rows.row(2).setConstant(std::numeric_limits<double>::quiet_NaN());
  rows.row(3) = Eigen::RowVectorXd::LinSpaced(kColumns, -1.0, 1.0);
  std::string expected = "# a comment\n";
  for (int i = 0; i < kColumns; ++i) {
    expected +=
        (i > 0 ? "," : "") + columns[static_cast<std::size_t>(i)].name + "[m]";
  }
  expected += '\n';
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    for (int i = 0; i < kColumns; ++i) {
      if (i > 0) expected += ',';
      AppendValue(columns[static_cast<std::size_t>(i)], rows(k, i), &expected);
    }
    expected += '\n';
  }
  ColumnCsv file(folder.Path("a.csv"), "# a comment\n", columns);
  file.Append(rows);
  file.Commit();
  EXPECT_EQ(folder.Read("a.csv"), expected);
}

TEST(ColumnCsv, GivesSomeRowsToAnotherAsWell) {
  const TemporaryFolder folder;
  const std::vector<SolutionColumn> columns = SomeColumns(2);
  Eigen::MatrixXd rows(3, 2);
  rows << 1.0, 2.0, 3.0, 4.0, 5.0, 6.0;
  ColumnCsv all(folder.Path("all.csv"), "", columns);
  ColumnCsv some(folder.Path("some.csv"), "# some\n", columns);
  all.Append(rows, {true, false, true}, &some);
  all.Append(rows, {false, false, false}, &some);
  some.Append(rows.topRows(1));
  all.Commit();
  some.Commit();
  const std::string three = "1.000,2\n3.000,4\n5.000,6\n";
  EXPECT_EQ(folder.Read("all.csv"), "c0[m],c1[m]\n" + three + three);
  EXPECT_EQ(folder.Read("some.csv"),
            "# some\nc0[m],c1[m]\n1.000,2\n5.000,6\n1.000,2\n");
}

}  // namespace
}  // namespace hindsight
