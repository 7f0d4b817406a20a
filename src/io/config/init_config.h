#ifndef HINDSIGHT_IO_CONFIG_INIT_CONFIG_H_
#define HINDSIGHT_IO_CONFIG_INIT_CONFIG_H_

#include <string>

namespace hindsight {

struct InitDraft {
  std::string text;
  bool has_imu = false;  ///< one was recognised
};

/// A commented configuration for the files found in `folder`, told apart by
/// their content: own CSV by its titles, RTKLIB .pos and EuRoC by their header,
/// KF-GINS, NCLT and control-point text by their columns, NMEA by its
/// sentences, plain or gzip; bags and OXTS folders by their names. It loads as
/// it stands if an IMU was recognised; else the place of one is a comment. What it cannot know (noise, lever arms,
/// axes) has values to be replaced, and says so. Files that were not recognised
/// are named in comments. `folder:` is written as an absolute path. Throws
/// InputError if the folder is missing or holds no files.
InitDraft InitConfig(const std::string& folder);

/// Whether the file is what InitConfig wrote, and nobody has changed it since:
/// its first line holds a checksum of the others. Throws InputError if it
/// cannot be read.
bool IsInitConfig(const std::string& path);

}  // namespace hindsight

#endif  // HINDSIGHT_IO_CONFIG_INIT_CONFIG_H_
