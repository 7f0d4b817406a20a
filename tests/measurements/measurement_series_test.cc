#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "base/random.h"
#include "measurements/measurement.h"

namespace hindsight {
namespace {

template <class T>
bool SameBytes(const T& a, const T& b) {
  const auto bytes = [](const T& value) {
    return reinterpret_cast<const std::byte*>(&value);
  };
  // NOLINTNEXTLINE(bugprone-sizeof-expression): pointers are values as well.
  return std::equal(bytes(a), bytes(a) + sizeof(T), bytes(b));
}

void Fill(Random* random, double* value) { *value = random->Normal(); }
void Fill(Random* random, bool* value) { *value = random->Uniform() < 0.5; }

template <class T>
requires std::is_enum_v<T>
void Fill(Random* random, T* value) {
  *value = static_cast<T>(random->Uniform() < 0.5 ? 0 : 1);
}

/// Any of two objects.
void Fill(Random* random, const GenericModel** model) {
  static const GenericModel models[2];
  *model = &models[random->Uniform() < 0.5 ? 0 : 1];
}

template <class T>
requires requires(T value) { value.begin(); }
void Fill(Random* random, T* values) {
  for (auto& value : *values) Fill(random, &value);
}

template <int R, int C>
void Fill(Random* random, Eigen::Matrix<double, R, C>* matrix) {
  for (double& value : matrix->reshaped()) Fill(random, &value);
}

template <class Model>
class EveryModel : public ::testing::Test {};

template <class Variant>
struct TypesOf;
template <class... Model>
struct TypesOf<std::variant<Model...>> {
  using Types = ::testing::Types<Model...>;
};
TYPED_TEST_SUITE(EveryModel, TypesOf<MeasurementModel>::Types);

TYPED_TEST(EveryModel, ComesBackBitForBit) {
  Random random(3);
  std::vector<TypeParam> models(PackedColumns::kRows + 100);
  MeasurementSeries series;
  for (std::size_t k = 0; k < models.size(); ++k) {
    std::apply([&](auto&... field) { (Fill(&random, &field), ...); },
               TypeParam::Fields(models[k]));
    series.push_back({0.01 * static_cast<double>(k), static_cast<int>(k % 3),
                      k % 2 == 0, models[k]});
  }
  ASSERT_EQ(series.size(), models.size());
  std::size_t k = 0;
  for (const Measurement& z : series) {
    ASSERT_EQ(z.t, 0.01 * static_cast<double>(k));
    ASSERT_EQ(z.sensor, static_cast<int>(k % 3));
    ASSERT_EQ(z.withheld, k % 2 == 0);
    const auto& model = std::get<TypeParam>(z.model);
    bool same = true;
    std::apply(
        [&](const auto&... a) {
          std::apply(
              [&](const auto&... b) {
                ((same = same && SameBytes(a, b)), ...);
              },
              TypeParam::Fields(models[k]));
        },
        TypeParam::Fields(model));
    ASSERT_TRUE(same) << k;
    ++k;
  }
}

/// The fields lie one behind the other and fill the model.
TYPED_TEST(EveryModel, ListsAllItsFields) {
  const TypeParam model;
  const auto address = [](const auto& value) {
    return reinterpret_cast<std::uintptr_t>(&value);
  };
  std::uintptr_t end = address(model);
  const auto follow = [&](const auto& field) {
    constexpr std::size_t kAlign =
        alignof(std::remove_cvref_t<decltype(field)>);
    EXPECT_EQ((end + kAlign - 1) / kAlign * kAlign, address(field));
    // NOLINTNEXTLINE(bugprone-sizeof-expression): pointers are values as well.
    end = address(field) + sizeof(std::remove_cvref_t<decltype(field)>);
  };
  std::apply([&](const auto&... field) { (follow(field), ...); },
             TypeParam::Fields(model));
  constexpr std::size_t kAlign = alignof(TypeParam);
  EXPECT_EQ((end + kAlign - 1) / kAlign * kAlign,
            address(model) + sizeof(model));
}

MeasurementSeries Heights(int count) {
  MeasurementSeries series;
  for (int k = 0; k < count; ++k) {
    series.push_back({1.0 * k, 0, false, HeightFix{100.0 + k, 1.0}});
  }
  return series;
}

TEST(MeasurementSeries, RowsAreChangedInALoopThatMayEndEarly) {
  MeasurementSeries series = Heights(10);
  for (Measurement& z : series.Edited()) {
    if (z.t == 2.0) continue;
    z.t += 0.5;
    if (z.t == 4.5) break;
  }
  series.Edit(9, [](Measurement& z) { z.withheld = true; });
  const double expected[] = {0.5, 1.5, 2.0, 3.5, 4.5, 5.0, 6.0, 7.0, 8.0, 9.0};
  for (std::size_t k = 0; k < series.size(); ++k) {
    EXPECT_EQ(series[k].t, expected[k]);
    EXPECT_EQ(series[k].withheld, k == 9);
  }
}

TEST(MeasurementSeries, RowsAreErasedInPlace) {
  constexpr int kCount = 2 * PackedColumns::kRows + 10;
  MeasurementSeries series = Heights(kCount);
  series.EraseIf([](const Measurement& z) { return std::fmod(z.t, 3.0) > 0; });
  ASSERT_EQ(series.size(), (kCount + 2) / 3);
  for (std::size_t k = 0; k < series.size(); ++k) {
    ASSERT_EQ(std::get<HeightFix>(series[k].model).height,
              100.0 + 3.0 * static_cast<double>(k));
  }
}

TEST(MeasurementSeries, IsSearchedByItsIterators) {
  const MeasurementSeries series = Heights(1000);
  const auto found =
      std::lower_bound(series.begin(), series.end(), 70.5,
                       [](const Measurement& z, double t) { return z.t < t; });
  EXPECT_EQ(found - series.begin(), 71);
  EXPECT_EQ(found->t, 71.0);
  EXPECT_EQ(series.front().t, 0.0);
  EXPECT_EQ(series.back().t, 999.0);
}

}  // namespace
}  // namespace hindsight
