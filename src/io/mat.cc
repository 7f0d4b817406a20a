#include <matio.h>

#include <memory>

#include "base/error.h"
#include "io/numeric_array.h"

namespace hindsight {
namespace {

struct CloseMat {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

std::string VariablesOf(mat_t* file) {
  std::size_t count = 0;
  char* const* names = Mat_GetDir(file, &count);
  std::string list;
  for (std::size_t i = 0; i < count; ++i) {
    list += (i > 0 ? ", " : "") + std::string(names[i]);
  }
  return list;
}

/// MATLAB's arrays stand column by column.
template <typename T>
void Fill(const matvar_t& variable, NumericArray* array) {
  const T* data = static_cast<const T*>(variable.data);
  const std::size_t count = array->rows * array->columns;
  array->values.resize(count);
  if (std::is_integral_v<T>) array->integers.resize(count);
  for (std::size_t row = 0; row < array->rows; ++row) {
    for (std::size_t column = 0; column < array->columns; ++column) {
      const std::size_t at = row * array->columns + column;
      const T value = data[column * array->rows + row];
      array->values[at] = static_cast<double>(value);
      if constexpr (std::is_integral_v<T>) {
        array->integers[at] = static_cast<std::int64_t>(value);
      }
    }
  }
}

bool FillAs(const matvar_t& variable, NumericArray* array) {
  switch (variable.data_type) {
    case MAT_T_DOUBLE:
      Fill<double>(variable, array);
      return true;
    case MAT_T_SINGLE:
      Fill<float>(variable, array);
      return true;
    case MAT_T_INT64:
      Fill<std::int64_t>(variable, array);
      return true;
    case MAT_T_INT32:
      Fill<std::int32_t>(variable, array);
      return true;
    case MAT_T_INT16:
      Fill<std::int16_t>(variable, array);
      return true;
    case MAT_T_INT8:
      Fill<std::int8_t>(variable, array);
      return true;
    case MAT_T_UINT32:
      Fill<std::uint32_t>(variable, array);
      return true;
    case MAT_T_UINT16:
      Fill<std::uint16_t>(variable, array);
      return true;
    case MAT_T_UINT8:
      Fill<std::uint8_t>(variable, array);
      return true;
    default:
      return false;
  }
}

}  // namespace

NumericArray ReadMat(const std::string& path, const std::string& variable) {
  const std::unique_ptr<mat_t, CloseMat> file(
      Mat_Open(path.c_str(), MAT_ACC_RDONLY));
  if (file == nullptr) throw InputError(path, 0, "is no MATLAB file");
  const Variable found(Mat_VarRead(file.get(), variable.c_str()));
  if (found == nullptr) {
    throw InputError(path, 0,
                     "has no variable '" + variable + "'; it holds " +
                         VariablesOf(file.get()));
  }
  NumericArray array;
  if (found->rank == 2 && found->data != nullptr && found->isComplex == 0) {
    array.rows = found->dims[0];
    array.columns = found->dims[1];
    if (array.rows == 1) std::swap(array.rows, array.columns);
    if (FillAs(*found, &array)) return array;
  }
  throw InputError(
      path, 0, "the variable '" + variable + "' is no real matrix of numbers");
}

}  // namespace hindsight
