#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/command_line.h"
#include "geometry/so3.h"

namespace hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using OrderedJson = nlohmann::ordered_json;

OrderedJson Summary(const std::filesystem::path& folder) {
  return OrderedJson::parse(ReadFile(folder / "summary.json"));
}
const OrderedJson& Best(const OrderedJson& summary) {
  return summary["methods"][summary["best"].get<std::string>()];
}

/// By name, of the constants of `method` as another recording starts from them:
/// the components m of a mounting become a rotation after it, J P J' with
/// J = LeftJacobian(m).
std::map<std::string, double> SigmasOfTheNext(const OrderedJson& method) {
  const OrderedJson& constants = method["constants"];
  const OrderedJson& rho = method["constant_correlations"];
  std::vector<std::string> names;
  for (const auto& [name, entry] : constants.items()) names.push_back(name);
  std::map<std::string, double> sigmas;
  for (std::size_t i = 0; i < names.size(); ++i) {
    sigmas[names[i]] = constants[names[i]]["sigma"];
    if (names[i] != "dvl_mounting[x]") continue;
    Eigen::Vector3d m;
    Eigen::Matrix3d P;
    for (int a = 0; a < 3; ++a) {
      const auto row = i + static_cast<std::size_t>(a);
      m(a) = constants[names[row]]["value"];
      for (int b = 0; b < 3; ++b) {
        const auto column = i + static_cast<std::size_t>(b);
        P(a, b) = rho[row][column].get<double>() *
                  constants[names[row]]["sigma"].get<double>() *
                  constants[names[column]]["sigma"].get<double>();
      }
    }
    const Eigen::Matrix3d J = LeftJacobian(m);
    const Eigen::Matrix3d rotated = J * P * J.transpose();
    for (int a = 0; a < 3; ++a) {
      sigmas["dvl_mounting[" + std::string(1, "xyz"[a]) + "]"] =
          std::sqrt(rotated(a, a));
    }
    i += 2;
  }
  return sigmas;
}

/// Four minutes of turns with a log whose lever arm and mounting are told
/// wrongly, otherwise in each seed; they are the same in truth. The offset of
/// the depth is another in each seed.
class Constants : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    for (const char* seed : {"1", "2", "3"}) {
      const std::string name = std::string("dive") + seed;
      const Outcome made =
          Hindsight({"simulate", "uuv_calibration", "--duration=240",
                     std::string("--seed=") + seed, "--set=imu.rate=50 Hz",
                     "--out=" + name},
                    folder_->path());
      ASSERT_EQ(made.status, 0) << made.err;
      const Outcome run =
          Hindsight({"run", name + "/config.yaml", "--methods=batch",
                     std::string("--out=result") + seed},
                    folder_->path());
      ASSERT_EQ(run.status, 0) << run.out << run.err;
    }
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static Outcome Run(const std::vector<std::string>& words) {
    return Hindsight(words, folder_->path());
  }
  static std::filesystem::path Path(const std::string& name) {
    return folder_->path() / name;
  }

  static std::unique_ptr<TemporaryFolder> folder_;
};
std::unique_ptr<TemporaryFolder> Constants::folder_;

TEST_F(Constants, CombineAveragesAndTellsWhatVaries) {
  const Outcome combined =
      Run({"combine", "result1", "result2", "result3", "--out=all"});
  EXPECT_EQ(combined.status, 3) << combined.out << combined.err;
  EXPECT_THAT(combined.out,
              HasSubstr("depth_offset differs between recordings"));
  EXPECT_THAT(combined.out, Not(HasSubstr("dvl_lever_arm[x] differs")));
  const OrderedJson all = Summary(Path("all"));
  EXPECT_EQ(all["best"], "combined");
  const OrderedJson& constants = Best(all)["constants"];
  // True are 1.2 and 0 m.
  for (const auto& [name, truth] :
       {std::pair{"dvl_lever_arm[x]", 1.2}, {"dvl_lever_arm[y]", 0.0}}) {
    const double sigma = constants[name]["sigma"];
    EXPECT_LT(std::abs(constants[name]["value"].get<double>() - truth),
              4.0 * sigma)
        << name;
    for (const char* one : {"result1", "result2", "result3"}) {
      EXPECT_LT(sigma, Best(Summary(Path(one)))["constants"][name]["sigma"]);
    }
  }
  EXPECT_EQ(Best(all)["constant_correlations"].size(), constants.size());
  EXPECT_EQ(Run({"combine", "result1", "--out=one"}).status, 2);
  // A recording counts once, also by way of another mean.
  for (const char* same : {"./result1", "all"}) {
    const Outcome twice = Run({"combine", "result1", same, "--out=twice"});
    EXPECT_EQ(twice.status, 2) << twice.out;
    EXPECT_THAT(twice.err, HasSubstr("of the same recording as result1"));
    EXPECT_THAT(twice.err, HasSubstr("imu.csv"));
  }
}

TEST_F(Constants, StartTheNextRecording) {
  const Outcome combined = Run({"combine", "result1", "result2", "--out=two"});
  EXPECT_TRUE(HasResults(combined)) << combined.err;
  const Outcome run = Run({"run", "dive3/config.yaml", "--methods=batch",
                           "--constants=two", "--out=next"});
  EXPECT_TRUE(HasResults(run)) << run.out << run.err;
  const OrderedJson two = Summary(Path("two"));
  const OrderedJson next = Summary(Path("next"));
  EXPECT_EQ(next["constants_from"], "two");
  const std::map<std::string, double> sigmas = SigmasOfTheNext(Best(two));
  for (const auto& [name, entry] : Best(two)["constants"].items()) {
    if (name == "depth_offset") continue;  // another one here
    const OrderedJson& here = Best(next)["constants"][name];
    EXPECT_NEAR(here["prior_sigma"].get<double>() / sigmas.at(name), 1.0, 1e-6)
        << name;
    EXPECT_LE(here["sigma"], 1.0001 * here["prior_sigma"].get<double>())
        << name;
  }
  // The mounting is taken as a whole: little is left to correct.
  const OrderedJson& yaw = Best(next)["constants"]["dvl_mounting[z]"];
  EXPECT_LT(std::abs(yaw["value"].get<double>()),
            4.0 * yaw["prior_sigma"].get<double>());
  // What started from a result would count again.
  const Outcome again = Run({"combine", "result1", "next", "--out=again"});
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.err, HasSubstr("started from two"));
  // A recording tells its constants once, also by way of a mean.
  for (const char* own : {"result1", "two"}) {
    const Outcome twice =
        Run({"run", "dive1/config.yaml", "--methods=rts",
             std::string("--constants=") + own, "--out=twice"});
    EXPECT_EQ(twice.status, 2) << twice.out;
    EXPECT_THAT(twice.err, HasSubstr("is of this recording: it read "));
    EXPECT_FALSE(std::filesystem::exists(Path("twice")));
  }
  // The resolved configuration loads the same.
  const Outcome resolved = Run({"run", "next/config.resolved.yaml",
                                "--methods=batch", "--out=resolved"});
  EXPECT_EQ(resolved.status, run.status) << resolved.err;
  EXPECT_EQ(Best(Summary(Path("resolved")))["constants"],
            Best(next)["constants"]);
}

TEST_F(Constants, WhatDoesNotFitIsOneLine) {
  std::string config = ReadFile(Path("dive3/config.yaml"));
  const auto with = [&](const std::string& constants) {
    WriteFile(Path("dive3/with.yaml"),
              config + "\nconstants: " + constants + "\n");
    return Run({"run", "dive3/with.yaml", "--methods=rts", "--out=with"});
  };
  EXPECT_THAT(with("{from: nowhere}").err, HasSubstr("constants.from: there"));
  EXPECT_THAT(with("{from: ../result1, method: imm}").err,
              HasSubstr("has no method 'imm'"));
  EXPECT_THAT(with("{from: ../result1, without: [gnss_scale]}").err,
              HasSubstr("has no constant 'gnss_scale'"));
  EXPECT_THAT(with("{from: config.yaml}").err,
              HasSubstr("no figures of a result"));
  const Outcome taken = with("{from: ../result1, without: [dvl_mounting]}");
  EXPECT_TRUE(HasResults(taken)) << taken.err;
  const OrderedJson summary = Summary(Path("with"));
  EXPECT_NEAR(Best(summary)["constants"]["dvl_mounting[z]"]["prior_sigma"]
                  .get<double>(),
              2.0 * std::acos(-1.0) / 180.0, 1e-9);
  // A constant of the result that is not estimated here.
  config.replace(config.find("scale:"), 6, "#");
  const Outcome missing = with("{from: ../result1}");
  EXPECT_EQ(missing.status, 2);
  EXPECT_EQ(Lines(missing.err).size(), 1u) << missing.err;
}

}  // namespace
}  // namespace hindsight
