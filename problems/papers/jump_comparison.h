#ifndef HINDSIGHT_PROBLEMS_PAPERS_JUMP_COMPARISON_H_
#define HINDSIGHT_PROBLEMS_PAPERS_JUMP_COMPARISON_H_

#include "problems/montecarlo.h"

namespace hindsight {

/// Positions being right or wrong in turn: kf0, kf1, imm and imm_smoother are
/// the methods of Baek (2019), see problems/position_imm.h; gated_ekf, rts,
/// batch and robust_batch those of Reconstruction.
///
/// Figures: position_rms and velocity_rms of an axis, north and east, [m] and
/// [m/s], and anees_horizontal, mean of e' P^-1 e, e the horizontal position
/// error (2 is right), all over runs and the times from 10 s on, when the
/// filters have forgotten the start. The same against time by axis, and the
/// mean probabilities of the modes of the paper's filters.
Trial JumpTrial();
StudyTable JumpTable();

}  // namespace hindsight

#endif  // HINDSIGHT_PROBLEMS_PAPERS_JUMP_COMPARISON_H_
