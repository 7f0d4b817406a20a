#include <iostream>
#include <nlohmann/json.hpp>

#include "app/gps_jumps_flags.h"
#include "app/montecarlo_scenarios.h"
#include "base/text.h"
#include "io/table.h"
#include "problems/jump_comparison.h"

namespace hindsight {
namespace {

/// When the filters have forgotten the start [s].
constexpr double kSettled = 10.0;
constexpr double kEnd = 250.0;

std::string Series(const JumpStatistics& m) {
  std::string text =
      "t[s],position_rms_n[m],position_rms_e[m],velocity_rms_n[m/s],"
      "velocity_rms_e[m/s],anees_horizontal[1]";
  const std::size_t modes =
      m.probabilities.empty()
          ? 0
          : static_cast<std::size_t>(m.probabilities[0].size());
  for (std::size_t j = 0; j < modes; ++j) {
    text += Format(",probability_%zu[1]", j);
  }
  text += "\n";
  for (std::size_t k = 0; k < m.t.size(); ++k) {
    text += Format("%.3f,%.6g,%.6g,%.6g,%.6g,%.6g", m.t[k],
                   m.position_rms[k].x(), m.position_rms[k].y(),
                   m.velocity_rms[k].x(), m.velocity_rms[k].y(), m.anees[k]);
    if (modes > 0) {
      for (const double p : m.probabilities[k]) text += Format(",%.6g", p);
    }
    text += "\n";
  }
  return text;
}

std::string Line(const GpsJumpsOptions& o, const JumpStatistics& m) {
  return Format("%s,%g,%g,%s,%.6g,%.6g,%.6g,%d,%.4g\n", o.profile.c_str(),
                o.gps_sigma, o.gps_rate_hz, m.name.c_str(),
                m.PositionRms(kSettled, kEnd), m.VelocityRms(kSettled, kEnd),
                m.Anees(kSettled, kEnd), m.failed, m.seconds);
}

std::string JsonText(const MonteCarloOptions& options, bool complete) {
  const nlohmann::ordered_json json = {{"scenario", kGpsJumpsName},
                                       {"complete", complete},
                                       {"runs", options.runs},
                                       {"first_seed", options.first_seed}};
  return json.dump(2) + "\n";
}

}  // namespace

void RunGpsJumps(MonteCarloOptions options, Progress* progress,
                 ResultFolder* folder) {
  const std::vector<GpsJumpsOptions> settings = ReadGpsJumpsFlags();
  std::string lines =
      "profile,gps_sigma[m],gps_rate[Hz],method,position_rms[m],"
      "velocity_rms[m/s],anees_horizontal[1],failed,seconds\n";
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> heading = {"errors, GPS"};
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const GpsJumpsOptions& o = settings[i];
    options.progress = [&](int done) {
      progress->Update("gps_jumps", (static_cast<double>(i) +
                                     static_cast<double>(done) / options.runs) /
                                        static_cast<double>(settings.size()));
    };
    const PerfectRecording recording(GpsJumps(o));
    const std::vector<JumpStatistics> methods = CompareOnJumps(
        [&](std::uint64_t seed) { return recording.Realize(seed); }, options);
    rows.push_back({Format("%s, %g m, %g Hz", o.profile.c_str(), o.gps_sigma,
                           o.gps_rate_hz)});
    for (const JumpStatistics& m : methods) {
      if (i == 0) heading.push_back(m.name);
      rows.back().push_back(Format("%.3f  %.1f", m.PositionRms(kSettled, kEnd),
                                   m.Anees(kSettled, kEnd)));
      lines += Line(o, m);
      folder->Write({Format("%s_%gm_%ghz_%s.csv", o.profile.c_str(),
                            o.gps_sigma, o.gps_rate_hz, m.name.c_str()),
                     Series(m)});
    }
    folder->Write({"gps_jumps.csv", lines});
    folder->Keep(kMonteCarloJson, JsonText(options, false));
  }
  progress->Clear();
  ReportTable table(heading);
  for (const std::vector<std::string>& row : rows) table.AddRow(row);
  std::cout << "gps_jumps, " << options.runs
            << " runs: root mean square of an axis of the position from 10 s "
               "on [m],\nand ANEES of the horizontal position (2 is right)\n\n"
            << table.Render();
  folder->Commit(kMonteCarloJson, JsonText(options, true));
}

}  // namespace hindsight
