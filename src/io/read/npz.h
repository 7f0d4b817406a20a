#ifndef HINDSIGHT_IO_READ_NPZ_H_
#define HINDSIGHT_IO_READ_NPZ_H_

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hindsight {

/// Whether a file of results is arrays, by its name: ".npz".
bool IsNpz(std::string_view path);

/// Columns by their names, all of the same length.
using NamedColumns = std::map<std::string, std::vector<double>>;

/// The arrays of a .npz, compressed or not. Throws InputError naming the file,
/// and the array, for a file that cannot be read, is damaged or cut off, or
/// holds none, and for an array that is not of one dimension (ReadNpy), is
/// there twice, or is of another length than the others.
NamedColumns ReadNpz(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_READ_NPZ_H_
