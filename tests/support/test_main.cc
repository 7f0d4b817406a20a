#include <gmock/gmock.h>

#include "base/freed_memory.h"

int main(int argc, char** argv) {
  hindsight::KeepFreedMemory();
  ::testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
