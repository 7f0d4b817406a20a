// The entry of a fuzzer; HINDSIGHT_FUZZ names its function.

#include "fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  hindsight::HINDSIGHT_FUZZ(data, size);
  return 0;
}
