#ifndef HINDSIGHT_ATTITUDE_MAGNETIC_REFERENCE_H_
#define HINDSIGHT_ATTITUDE_MAGNETIC_REFERENCE_H_

namespace hindsight {

/// Norm and dip of the undisturbed field, learned as it is met, and the verdict
/// whether a reading agrees with them; thresholds as in VQF (Laidig and Seel
/// 2023, table 2), which bounds the same two quantities.
struct MagneticReferenceOptions {
  bool enabled = true;          ///< false: every reading is undisturbed
  double norm = 0.0;            ///< known beforehand [uT]; 0: to be learned
  double dip = 0.0;             ///< known beforehand [rad]
  double norm_limit = 0.1;      ///< deviation as a part of the norm [1]
  double dip_limit = 0.1745;    ///< deviation of the dip [rad]
  double smoothing = 0.05;      ///< low-pass of the readings judged [s]
  double memory = 20.0;         ///< with which the reference follows [s]
  double settle = 0.5;          ///< agreement before readings are used [s]
  double first_adoption = 5.0;  ///< of a steady field as first reference [s]
  double adoption = 20.0;       ///< of another one in its place, moving [s]
  double moving_rate = 0.35;    ///< what counts as moving [rad/s]
};

/// A field as steady as the limits ask, for as long as the adoption time,
/// becomes the reference: after a change of surroundings the old one would
/// reject everything for ever. Only time in motion counts for replacing one:
/// at rest a disturbance is as steady as the Earth's field.
class MagneticReference {
 public:
  explicit MagneticReference(const MagneticReferenceOptions& options)
      : options_(options) {
    reference_.norm = options.norm;
    reference_.dip = options.dip;
  }

  /// Judges a reading; dt since the one before [s], norm [uT], dip [rad], rate
  /// of the motion [rad/s]. True if it may be used.
  bool Accept(double dt, double norm, double dip, double rate);

  bool is_known() const { return reference_.norm > 0.0; }
  /// How often a field became the reference.
  int adoptions() const { return adoptions_; }
  double norm() const { return reference_.norm; }
  double dip() const { return reference_.dip; }

 private:
  struct Field {
    double norm = 0.0;
    double dip = 0.0;
    /// Moves towards `other` by `gain`.
    void Follow(const Field& other, double gain) {
      norm += gain * (other.norm - norm);
      dip += gain * (other.dip - dip);
    }
  };
  bool Agrees(const Field& a, const Field& b) const;
  void Adopt(double dt, double rate);

  MagneticReferenceOptions options_;
  Field smoothed_;
  Field reference_;
  Field candidate_;
  double agreed_for_ = 0.0;     ///< with the reference [s]
  double candidate_for_ = 0.0;  ///< steadiness of the candidate [s]
  double candidate_age_ = 0.0;  ///< with standstill, which sets its gain [s]
  bool started_ = false;
  int adoptions_ = 0;
};

}  // namespace hindsight

#endif  // HINDSIGHT_ATTITUDE_MAGNETIC_REFERENCE_H_
