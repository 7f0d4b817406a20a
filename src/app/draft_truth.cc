#include "app/draft_truth.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/units.h"
#include "dataset/truth_lever_arm.h"
#include "earth/wgs84.h"
#include "io/config/key_line_edit.h"

namespace hindsight {
namespace {

void StartFrom(const TruthPoint& point, RecordingDraft* draft) {
  constexpr char kWhy[] = "no stream tells where it begins";
  const bool whole = point.v_n && point.q_nb;
  const Geodetic place = GeodeticFromEcef(*point.p_e);
  const auto at =
      std::find_if(draft->top.begin(), draft->top.end(),
                   [](const KeyLine& line) { return line.key == "initial"; });
  std::vector<KeyLine> lines = {{"  position_sigma", "1 m", "(a guess)"}};
  if (whole) {
    lines.insert(lines.begin(), {"  from", "truth", kWhy});
  } else {
    lines.insert(lines.begin(),
                 {{"  time", fmt::format("{:.6f} s", point.t), "of that"},
                  {"  position",
                   fmt::format("[{:.9f} deg, {:.9f} deg, {:.3f} m]",
                               place.latitude / kDegree,
                               place.longitude / kDegree, place.height),
                   std::string(kWhy) + ": the truth's first"}});
  }
  draft->top.insert(at + 1, lines.begin(), lines.end());
  draft->Assume(
      "no stream tells the position: the truth's first is the start "
      "(initial.position)");
}

}  // namespace

void TakePlaceOfTruth(const Dataset& dataset, RecordingDraft* draft) {
  constexpr double kElsewhere = 1e4;  // m
  const KeyLine* place = FindLine(draft->top, "  position");
  if (place == nullptr) return;
  const Eigen::Vector3d nowhere = EcefFromGeodetic({});
  for (const TruthPoint& point : dataset.truth) {
    if (point.t < dataset.imu.t_begin() || !point.p_e) continue;
    if ((*point.p_e - nowhere).norm() < kElsewhere) return;
    std::erase_if(draft->top, [](const KeyLine& line) {
      return line.key.starts_with("  position");
    });
    std::erase_if(draft->assumptions, [](const std::string& assumption) {
      return assumption.starts_with("no stream tells the position");
    });
    StartFrom(point, draft);
    return;
  }
}

void TellTruthPoint(const Dataset& dataset, RecordingDraft* draft) {
  constexpr double kSure = 5.0;   // sigmas
  constexpr double kFar = 0.1;    // m
  constexpr double kKnown = 0.3;  // m
  if (!draft->truth) return;
  const auto found = FindTruthLeverArm(dataset);
  const bool apart =
      found && ((found->l_b.array().abs() > kSure * found->sigma.array()) &&
                (found->l_b.array().abs() > kFar))
                   .any();
  if (apart) {
    SetLine({"lever_arm",
             fmt::format("[{:.2f}, {:.2f}, {:.2f} m]", found->l_b.x(),
                         found->l_b.y(), found->l_b.z()),
             fmt::format("of the point it speaks of: its velocities in turns "
                         "say so, +- {:.2g}, {:.2g}, {:.2g} m (likely)",
                         found->sigma.x(), found->sigma.y(), found->sigma.z())},
            &draft->truth->lines);
    return;
  }
  const bool known = found && found->sigma.maxCoeff() < kKnown;
  if (FindLine(draft->top, "  from") != nullptr && !known) {
    draft->Assume("truth: taken to speak of the point where the IMU is");
  }
}

}  // namespace hindsight
