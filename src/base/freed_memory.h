#ifndef HINDSIGHT_BASE_FREED_MEMORY_H_
#define HINDSIGHT_BASE_FREED_MEMORY_H_

namespace hindsight {

/// Gives the system back what the process has freed and holds in reserve, of which a
/// thread that has ended leaves much; where the system knows how. Takes milliseconds.
void ReleaseFreedMemory();

/// Keeps freed memory of the whole process for the next large matrix: given back to the
/// system, it would be cleared by it page by page each time, a quarter of a long run.
void KeepFreedMemory();

}  // namespace hindsight

#endif  // HINDSIGHT_BASE_FREED_MEMORY_H_
