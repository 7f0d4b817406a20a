#include "app/draft_refinement.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "alignment/mounting_search.h"
#include "app/draft_noise.h"
#include "app/draft_places.h"
#include "app/draft_timing.h"
#include "app/draft_truth.h"
#include "app/draft_turns.h"
#include "app/draft_wheel.h"
#include "base/error.h"
#include "base/units.h"
#include "dataset/checks.h"
#include "dataset/gyro_unit.h"
#include "dataset/median_field.h"
#include "dataset/mirrored_axis.h"
#include "geometry/so3.h"
#include "io/config/config.h"
#include "io/config/init_config.h"
#include "io/config/key_line_edit.h"

namespace hindsight {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Refiner {
 public:
  Refiner(Progress* progress, RecordingDraft* draft)
      : progress_(*progress), draft_(*draft) {}

  void Refine() {
    Say("axes");
    if (!Load()) return;
    SetAxes();
    TellReadingNoise(dataset_, &draft_);
    ResolveMirror();
    if (IsAttitudeAlone(draft_)) {
      if (Load()) SetField();
      if (Load()) TellFieldClock(dataset_, &draft_);
      if (Load()) TellTruthClock(dataset_, &draft_);
      Load();
      return;
    }
    Say("places");
    // How fine they are decides over which time their motion is compared.
    const auto with_noise = [this]() -> const Dataset* {
      if (!Load()) return nullptr;
      TellFixNoise(dataset_, &draft_);
      return Load() ? &dataset_ : nullptr;
    };
    TellPlaces(with_noise, &draft_);
    if (!Load()) return;
    Say("rates of turn");
    if (TellTurns(dataset_, &draft_)) {
      if (!Load()) return;
      SetAxes();
      if (!Load()) return;
      TellReadingNoise(dataset_, &draft_);
      if (!Load()) return;
    }
    TakePlaceOfTruth(dataset_, &draft_);
    TellFixNoise(dataset_, &draft_);
    if (!Load()) return;
    Say("clocks");
    TellClocks(dataset_, &draft_);
    if (!Load()) return;
    if (TellWheels(dataset_, &draft_) && !Load()) return;
    TellStretch(dataset_, &draft_);
    if (const std::string odd = WarnAboutGyroUnit(dataset_); !odd.empty()) {
      draft_.Assume(odd);
    } else if (TellOtherHand()) {
      return;
    }
    Say("forward axis");
    SetForward();
    TellTruthClock(dataset_, &draft_);
    if (!Load()) return;
    TellTruthPoint(dataset_, &draft_);
    TellFixNoise(dataset_, &draft_);
    if (!Load()) return;
    TellLikelyNoise(
        dataset_, [this](double fraction) { Say("noise", fraction); }, &draft_);
    Load();
  }

 private:
  void Say(const char* what, double fraction = 0.0) {
    progress_.Update("looking at " + draft_.name + ": " + what, fraction);
  }

  bool Load() {
    try {
      dataset_ =
          LoadDataset(draft_.name + ".yaml", {.text = DraftText(draft_)});
      draft_.loads = true;
    } catch (const InputError&) {
      draft_.loads = false;
    }
    return draft_.loads;
  }

  void SetAxes() {
    const CheckReport report = CheckDataset(dataset_);
    const bool known = !report.axes.starts_with("unknown");
    const std::string axes = report.suggested_axes;
    SetLine(
        {"axes", axes.empty() ? "[x, y, z]" : axes,
         known ? "by gravity: " + report.axes.substr(0, report.axes.find(';'))
               : "which axis is down is not shown (a guess)"},
        &draft_.imu->lines);
    if (!known && !IsAttitudeAlone(draft_)) {
      draft_.Assume("imu: no axis feels gravity on average: which one is down");
    }
    for (StreamDraft& stream : draft_.aiding) {
      if (stream.kind->magnetic && !axes.empty()) {
        SetLine({"axes", axes, "as of the IMU"}, &stream.found.lines);
      }
    }
  }

  /// Which axis is mirrored, where gravity turns against the gyros.
  void ResolveMirror() {
    constexpr double kShown = 0.5;
    const auto& guess = draft_.imu->imu_guess;
    if (!guess || guess->turn.correlation > -kShown || !Load()) return;
    const auto found = FindMirroredAxis(dataset_);
    if (!found) return;
    TurnRound(found->axis);
    const std::string what =
        found->axis == 3
            ? "the gyros have the other sign"
            : std::string("its ") + "xyz"[found->axis] + " axis is mirrored";
    std::erase_if(draft_.assumptions, [](const std::string& assumption) {
      return assumption.find("an axis is mirrored in both") !=
             std::string::npos;
    });
    draft_.Assume(
        fmt::format("imu: {}: gravity turns against the gyros, and the "
                    "velocities fit so (misfit {:.2g} against {:.2g})",
                    what, found->misfit, found->next_misfit));
  }

  /// Whether the axes are left-handed: then all else that the motion seems to
  /// say is wrong.
  bool TellOtherHand() {
    const auto found = FindOtherHand(dataset_);
    if (!found) return false;
    draft_.Assume("imu: " + Describe(*found));
    return true;
  }

  /// In the file's columns, which body axis `axis` comes from.
  void TurnRound(int axis) {
    std::vector<KeyLine>& lines = draft_.imu->lines;
    std::string letter;
    if (axis < 3) {
      const std::string axes = FindLine(lines, "axes")->value;
      int seen = -1;
      for (const char c : axes) {
        if (c >= 'x' && c <= 'z' && ++seen == axis) letter = std::string(1, c);
      }
    }
    for (KeyLine& line : lines) {
      const bool gyro =
          line.key.starts_with("  gyro_") && line.value.starts_with('"');
      const bool accel =
          line.key.starts_with("  accel_") && line.value.starts_with('"');
      const bool hit =
          axis == 3 ? gyro : (gyro || accel) && line.key.ends_with(letter);
      if (!hit) continue;
      line.value.insert(1, "-");
      line.comment +=
          (line.comment.empty() ? "" : "; ") + std::string("mirrored (likely)");
    }
  }

  void SetField() {
    for (const AidingStream& stream : dataset_.streams) {
      StreamDraft* draft = draft_.Find(stream.sensor.name);
      if (draft == nullptr || !stream.sensor.kind->magnetic) continue;
      const auto field = FindMedianField(dataset_.imu, stream);
      if (!field) continue;
      std::vector<KeyLine>& lines = draft->found.lines;
      const std::string why = "median of what it reads against gravity";
      SetLine({"horizontal", fmt::format("{:.3g} uT", field->horizontal), why},
              &lines);
      SetLine({"down", fmt::format("{:.3g} uT", field->down), why}, &lines);
    }
  }

  /// The axis along which it is accelerated as it runs.
  void SetForward() {
    constexpr double kLevel = 1.0;  // deg
    const auto found = FindMounting(dataset_, -kInfinity, kInfinity);
    const bool odometer = std::any_of(
        draft_.aiding.begin(), draft_.aiding.end(),
        [](const StreamDraft& s) { return s.kind == &OdometerKind(); });
    if (!found) {
      if (odometer) {
        draft_.Assume("imu: the motion does not show which axis is forward");
      }
      return;
    }
    const Eigen::Vector3d euler = EulerFromQuaternion(found->q_ob) / kDegree;
    SetLine(
        {"mounting",
         fmt::format("[{:.1f}, {:.1f}, {:.1f} deg]", euler.x(), euler.y(),
                     euler.z()),
         fmt::format("forward is where starts, stops and turns say, +- {:.1f}"
                     " deg (likely)",
                     found->yaw_sigma / kDegree)},
        &draft_.imu->lines);
    SetLine(
        {"mounting_sigma",
         fmt::format("[{0:.1f}, {0:.1f}, {1:.1f} deg]", kLevel,
                     std::max(found->yaw_sigma / kDegree, 0.1)),
         "level on average (a guess), and as above: attitudes are no better "
         "known"},
        &draft_.imu->lines);
    if (odometer) return;
    StreamDraft wheels{"wheels", &NonHolonomicKind(), {}};
    wheels.found.lines = {
        {"rate", "1 Hz"},
        {"sigma", "[0.05, 0.1 m/s]", "to the side and down (a guess)"},
        {"level_on_average", "1 deg", "of the road's camber"},
        {"estimate", "{mounting: 10 deg, lever_arm: 1 m}"}};
    draft_.aiding.push_back(std::move(wheels));
    draft_.Assume(
        "wheels: taken for a vehicle on wheels, as it is accelerated along its "
        "course");
  }

  Progress& progress_;
  RecordingDraft& draft_;
  Dataset dataset_;
};

}  // namespace

bool IsAttitudeAlone(const RecordingDraft& draft) {
  return std::all_of(
      draft.aiding.begin(), draft.aiding.end(),
      [](const StreamDraft& stream) { return stream.kind->magnetic; });
}

void RefineDraft(Progress* progress, RecordingDraft* draft) {
  Refiner(progress, draft).Refine();
}

std::vector<RecordingDraft> DraftFolder(const std::string& folder,
                                        Progress* progress) {
  progress->Update("reading " + folder, 0.0);
  std::vector<RecordingDraft> drafts = DraftRecordings(folder);
  for (RecordingDraft& draft : drafts) RefineDraft(progress, &draft);
  return drafts;
}

}  // namespace hindsight
