#ifndef HINDSIGHT_FACTORS_STATE_BLOCKS_H_
#define HINDSIGHT_FACTORS_STATE_BLOCKS_H_

#include <ceres/manifold.h>

#include <vector>

#include "state/state.h"

namespace hindsight {

/// How a layout is spread over the parameter blocks of a whole-interval
/// problem. Blocks that change with time stand once a node, in one parameter
/// block; blocks that are constant stand once, a parameter block each
/// ("global"). All of a layout's blocks must be complete (no masked axes).
///
/// A node's ambient values are p_e, v_e, q_eb (x y z w), then the additive
/// blocks in layout order; its tangent is that of the layout (Retract, Local)
/// restricted to the node's blocks, in layout order.
class StateBlocks {
 public:
  /// Throws std::logic_error if position, velocity or attitude is missing or
  /// an axis is masked.
  explicit StateBlocks(const ErrorLayout& layout);

  const ErrorLayout& layout() const { return layout_; }
  int node_ambient_dim() const { return node_ambient_dim_; }
  int node_dim() const { return node_dim_; }
  int global_dim() const { return global_dim_; }

  /// A block of the layout and where its values are.
  struct Entry {
    Block block;
    bool global = false;
    int ambient = 0;  ///< first ambient value in the node, or global's number
    int tangent = 0;  ///< first column in the node tangent, or in the globals'
  };
  const std::vector<Entry>& entries() const { return entries_; }
  /// Global entries in order; a parameter block each.
  const std::vector<Entry>& globals() const { return globals_; }

  /// Copies a state into ambient values of a node.
  void WriteNode(const State& x, double* ambient) const;
  /// The values of global block g from a state.
  void WriteGlobal(const State& x, int g, double* values) const;
  /// The state of a node; `globals` has a pointer per global block, nullptr
  /// where the value is not needed (left zero).
  State ReadState(double t, const double* ambient,
                  const std::vector<const double*>& globals) const;

 private:
  ErrorLayout layout_;
  std::vector<Entry> entries_;
  std::vector<Entry> globals_;
  int node_ambient_dim_ = 0;
  int node_dim_ = 0;
  int global_dim_ = 0;
};

/// The manifold of a node's parameter block: Plus is Retract, Minus is Local,
/// in the NED axes at x, with their true Jacobians.
class NodeManifold : public ceres::Manifold {
 public:
  /// `blocks` must outlive the manifold.
  explicit NodeManifold(const StateBlocks* blocks) : blocks_(*blocks) {}

  int AmbientSize() const override { return blocks_.node_ambient_dim(); }
  int TangentSize() const override { return blocks_.node_dim(); }
  bool Plus(const double* x, const double* delta,
            double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x,
             double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;

 private:
  const StateBlocks& blocks_;
};

}  // namespace hindsight

#endif  // HINDSIGHT_FACTORS_STATE_BLOCKS_H_
