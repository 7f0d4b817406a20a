#include "io/write/solution_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/units.h"
#include "io/full_table.h"
#include "state/euler_error.h"
#include "support/temporary_folder.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

TEST(SolutionCsv, ComesBackAsWritten) {
  const TemporaryFolder folder;
  const SolutionTable table = FullTable();
  WriteSolutionCsv(folder.Path("a.csv"), table, "hindsight 0", {});
  const SolutionTable back = ReadSolutionTable(folder.Path("a.csv"));
  EXPECT_EQ(back.method, "batch");
  ASSERT_EQ(back.t, table.t);
  for (std::size_t k = 0; k < table.size(); ++k) {
    // Half of the last decimals written.
    EXPECT_LT((back.p_e[k] - table.p_e[k]).norm(), 1e-7);
    EXPECT_LT((back.v_e[k] - table.v_e[k]).norm(), 1e-8);
    EXPECT_LT((back.q_nb(k).coeffs() - table.q_nb(k).coeffs()).norm() *
                  (back.q_nb(k).coeffs() + table.q_nb(k).coeffs()).norm(),
              1e-11);
    EXPECT_TRUE(back.P_position[k].isApprox(table.P_position[k], 1e-11));
    EXPECT_TRUE(back.P_velocity[k].isApprox(table.P_velocity[k], 1e-11));
    EXPECT_TRUE(back.P_attitude[k].isApprox(table.P_attitude[k], 1e-11));
    EXPECT_TRUE(back.sigma_euler[k].isApprox(table.sigma_euler[k], 1e-11));
    EXPECT_TRUE(back.b_g[k].isApprox(table.b_g[k], 1e-11));
    EXPECT_TRUE(back.b_a[k].isApprox(table.b_a[k], 1e-11));
    EXPECT_TRUE(back.sigma_b_g[k].isApprox(table.sigma_b_g[k], 1e-11));
    EXPECT_TRUE(back.sigma_b_a[k].isApprox(table.sigma_b_a[k], 1e-11));
  }
  EXPECT_THAT(folder.Entries(), UnorderedElementsAre("a.csv"));
}

TEST(SolutionCsv, SaysInACommentWhatItsTimesCountFrom) {
  const TemporaryFolder folder;
  // 2025-07-08 19:34:21.5 of GPS time, 18 s ahead of UTC.
  WriteSolutionCsv(folder.Path("a.csv"), FullTable(), "hindsight 0",
                   (2374LL * 604800 + 243261) * 1'000'000'000 + 500'000'000);
  EXPECT_THAT(folder.Read("a.csv"),
              HasSubstr("\n# epoch: t = 0 is GPS week 2374 second "
                        "243261.500000000, 2025-07-08T19:34:03.500Z\n"));
  EXPECT_EQ(ReadSolutionTable(folder.Path("a.csv")).t, FullTable().t);
  WriteSolutionCsv(folder.Path("b.csv"), FullTable(), "hindsight 0", {});
  EXPECT_THAT(folder.Read("b.csv"),
              HasSubstr("\n# epoch: the recording's clock has no date\n"));
}

TEST(SolutionCsv, HasTheDocumentedColumns) {
  const TemporaryFolder folder;
  WriteSolutionCsv(folder.Path("a.csv"), FullTable(), "hindsight 0", {});
  EXPECT_THAT(
      folder.Read("a.csv"),
      HasSubstr(
          "\nt[s],lat[deg],lon[deg],h[m],v_n[m/s],v_e[m/s],v_d[m/s],roll[deg],"
          "pitch[deg],heading[deg],sd_n[m],sd_e[m],sd_d[m],sd_v_n[m/s],"
          "sd_v_e[m/s],sd_v_d[m/s],sd_roll[deg],sd_pitch[deg],sd_heading[deg],"
          "bg_x[deg/h],bg_y[deg/h],bg_z[deg/h],ba_x[m/s^2],ba_y[m/s^2],"
          "ba_z[m/s^2],sd_bg_x[deg/h],sd_bg_y[deg/h],sd_bg_z[deg/h],"
          "sd_ba_x[m/s^2],sd_ba_y[m/s^2],sd_ba_z[m/s^2],cov_p_ne[m^2],"
          "cov_p_nd[m^2],cov_p_ed[m^2],cov_v_ne[m^2/s^2],cov_v_nd[m^2/s^2],"
          "cov_v_ed[m^2/s^2],cov_psi_nn[rad^2],cov_psi_ne[rad^2],"
          "cov_psi_nd[rad^2],cov_psi_ee[rad^2],cov_psi_ed[rad^2],"
          "cov_psi_dd[rad^2]\n"));
}

TEST(SolutionCsv, GivesRollAndPitchSigmasInTheBodysDirections) {
  // Heading east, roll is a rotation about east and pitch one about south.
  const TemporaryFolder folder;
  SolutionTable table;
  table.t = {1.0};
  table.q_eb = {QuaternionFromEuler(0.0, 0.0, 0.5 * kPi)};
  table.P_attitude = {Eigen::Matrix3d(
      Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal() * (kDegree * kDegree))};
  table.sigma_euler = {EulerSigma({0.0, 0.0, 0.5 * kPi}, table.P_attitude[0])};
  WriteSolutionCsv(folder.Path("a.csv"), table, "hindsight 0", {});
  const std::string text = folder.Read("a.csv");
  EXPECT_THAT(text, HasSubstr("\nt[s],roll[deg],pitch[deg],heading[deg],"
                              "sd_roll[deg],sd_pitch[deg],sd_heading[deg],"
                              "cov_psi_nn[rad^2]"));
  EXPECT_THAT(text, HasSubstr("\n1,0.0000000000,0.0000000000,90.0000000000,"
                              "2,1,3,"));
}

TEST(SolutionCsv, ReadsSigmasWithoutCrossTermsAndOtherUnits) {
  const TemporaryFolder folder;
  const std::string path = folder.Write(
      "a.csv",
      "\xEF\xBB\xBF# any\r\n"
      "note[1],heading[rad],pitch[rad],roll[rad],t[ms],sd_roll[deg],"
      "sd_pitch[deg],sd_heading[deg]\r\n"
      "7,1.5,0.25,-0.5,2500,1,2,3\r\n"
      "7,1.5,0.25,-0.5,3500,1,2,3\r\n");
  const SolutionTable table = ReadSolutionTable(path);
  ASSERT_EQ(table.size(), 2u);
  EXPECT_DOUBLE_EQ(table.t[0], 2.5);
  EXPECT_LT(
      (EulerFromQuaternion(table.q_nb(1)) - Eigen::Vector3d(-0.5, 0.25, 1.5))
          .norm(),
      1e-12);
  EXPECT_TRUE(table.p_e.empty());
  // Written again, the standard deviations are those read.
  WriteSolutionCsv(folder.Path("b.csv"), table, "hindsight 0", {});
  EXPECT_THAT(folder.Read("b.csv"), HasSubstr(",1,2,3,"));
}

TEST(SolutionCsv, NamesFileLineAndFault) {
  const struct {
    const char* text;
    const char* expected;
  } cases[] = {
      {"", "a.csv"},
      {"# nothing\n", "no epoch"},
      {"lat[deg],lon[deg],h[m]\n", "a.csv:1: no column t[s]"},
      {"t[s],lat[deg],lon[deg]\n", "column h[m] is missing beside lat[deg]"},
      {"t[s],h[s]\n", "h[s]: expected the unit [m]"},
      {"t[s],t[s]\n", "t[s] appears twice"},
      {"t[s],cov_p_ne[mm^2]\n", "expected the unit [m^2]"},
      {"t[s],h[m],lat[deg],lon[deg]\n1,2,3\n", "a.csv:2: 3 fields, expected 4"},
      {"t[s],x[m]\n1,2\n3,4", "a.csv:3: the last line has no line end"},
      {"t[s]\n1\nnan\n", "a.csv:3: 'nan' is not a finite number"},
      {"t[s]\n1\n2x\n", "a.csv:3: '2x' is not a finite number"},
      {"t[s]\n2\n2\n", "a.csv:3: time 2 is not after"},
      {"t[s],lat[deg],lon[deg],h[m]\n1,91,0,0\n",
       "a.csv:2: the latitude is 91 deg; expected -90 to 90 deg"},
  };
  const TemporaryFolder folder;
  for (const auto& c : cases) {
    const std::string path = folder.Write("a.csv", c.text);
    try {
      ReadSolutionTable(path);
      ADD_FAILURE() << "no error for: " << c.text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(c.expected));
      EXPECT_THAT(error.what(), HasSubstr(path));
    }
  }
  EXPECT_THROW(ReadSolutionTable(folder.Path("absent.csv")), InputError);
}

}  // namespace
}  // namespace hindsight
