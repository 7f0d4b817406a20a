#include "io/write/table.h"

#include <gtest/gtest.h>

#include <sstream>

namespace hindsight {
namespace {

ReportTable Wide() {
  ReportTable table({"method", "first\nfigure", "second", "empty", "grade"});
  table.AddRow({"ekf", "1.00", "22.0", "", "usable"});
  table.AddRow({"batch", "", "3.5", "", "not usable"});
  return table;
}

TEST(ReportTable, LeavesOutEmptyColumnsAndEndsNoLineWithBlanks) {
  EXPECT_EQ(Wide().Render(),
            "         first\n"
            "method  figure  second       grade\n"
            "ekf       1.00    22.0      usable\n"
            "batch              3.5  not usable\n");
}

TEST(ReportTable, FoldsToTheWidthWithTheFirstColumnAgain) {
  EXPECT_EQ(Wide().Render({.width = 24}),
            "         first\n"
            "method  figure  second\n"
            "ekf       1.00    22.0\n"
            "batch              3.5\n"
            "\n"
            "method       grade\n"
            "ekf         usable\n"
            "batch   not usable\n");
  // One column beside the first is the least.
  std::istringstream narrow(Wide().Render({.width = 3}));
  for (std::string line; std::getline(narrow, line);) {
    EXPECT_LE(line.size(), 18u);
  }
}

TEST(ReportTable, PaintsGradesAlone) {
  const TableStyle style = {.colour = true};
  EXPECT_EQ(PaintGrade("usable", style), "\033[32musable\033[0m");
  EXPECT_EQ(PaintGrade("doubtful", style), "\033[33mdoubtful\033[0m");
  EXPECT_EQ(PaintGrade("not usable", style), "\033[31mnot usable\033[0m");
  EXPECT_EQ(PaintGrade("ekf", style), "ekf");
  EXPECT_EQ(PaintGrade("usable", {}), "usable");
  // Colour takes no room.
  const std::string text = Wide().Render(style);
  EXPECT_NE(text.find("    \033[32musable\033[0m\n"), text.npos);
}

}  // namespace
}  // namespace hindsight
