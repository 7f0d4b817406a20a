#ifndef HINDSIGHT_TESTS_APP_COMMAND_LINE_H_
#define HINDSIGHT_TESTS_APP_COMMAND_LINE_H_

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace hindsight {

inline std::string ReadFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline void WriteFile(const std::filesystem::path& path,
                      const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
}

/// Lines without their ends.
inline std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

inline std::string Join(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// Names in a folder, hidden ones too, sorted.
inline std::vector<std::string> Names(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// A folder of its own, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "hindsight-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
      throw std::runtime_error("mkdtemp failed");
    }
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// How a run of the command ended.
struct Outcome {
  int status = -1;  ///< exit status, or 128 + signal
  std::string out;
  std::string err;
  double peak_memory = 0.0;  ///< [MB]
};

/// Whether it ended with complete results, usable or doubtful.
inline bool HasResults(const Outcome& outcome) {
  return outcome.status == 0 || outcome.status == 3;
}

/// `hindsight words...` as a child process in the folder `directory`, after
/// `prepare` in that process.
class Child {
 public:
  Child(std::vector<std::string> words, const std::filesystem::path& directory,
        const std::function<void()>& prepare = {}) {
    words.insert(words.begin(), HINDSIGHT_BINARY);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error("fork failed");
    if (pid_ == 0) {
      const int out = creat((streams_.path() / "out").c_str(), 0600);
      const int err = creat((streams_.path() / "err").c_str(), 0600);
      const int in = open("/dev/null", O_RDONLY);
      if (chdir(directory.c_str()) != 0 || dup2(in, STDIN_FILENO) < 0 ||
          dup2(out, STDOUT_FILENO) < 0 || dup2(err, STDERR_FILENO) < 0) {
        _exit(125);
      }
      // Of a background job of a shell they are ignored, and stay so.
      for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        std::signal(number, SIG_DFL);
      }
      if (prepare) prepare();
      execv(argv[0], argv.data());
      _exit(126);
    }
  }
  ~Child() {
    if (!ended_) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void Signal(int signal) const { kill(pid_, signal); }

  /// Waits until it has reported the stage, with --progress=json; false if it
  /// ends before.
  bool AwaitStage(const std::string& stage) const {
    while (Err().find('"' + stage + '"') == std::string::npos) {
      siginfo_t ended = {};
      waitid(P_PID, static_cast<id_t>(pid_), &ended,
             WEXITED | WNOHANG | WNOWAIT);
      if (ended.si_pid != 0) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }

  /// Halts it there, so that what is done meanwhile comes before its end
  /// however slow it is; false as AwaitStage.
  bool PauseAt(const std::string& stage) const {
    if (!AwaitStage(stage)) return false;
    Signal(SIGSTOP);
    return true;
  }
  void Resume() const { Signal(SIGCONT); }

  /// What it has written to stderr so far.
  std::string Err() const { return Stream("err"); }

  Outcome Wait() {
    int raw = 0;
    struct rusage usage = {};
    wait4(pid_, &raw, 0, &usage);
    ended_ = true;
    Outcome outcome;
    outcome.peak_memory = static_cast<double>(usage.ru_maxrss) / 1024.0;
    outcome.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
    outcome.out = Stream("out");
    outcome.err = Stream("err");
    return outcome;
  }

 private:
  /// What is in one of its streams; a process killed while young has none.
  std::string Stream(const char* name) const {
    const std::filesystem::path path = streams_.path() / name;
    return std::filesystem::exists(path) ? ReadFile(path) : "";
  }

  TemporaryFolder streams_;
  pid_t pid_ = -1;
  bool ended_ = false;
};

/// Runs `hindsight words...` in `directory` to its end.
inline Outcome Hindsight(const std::vector<std::string>& words,
                         const std::filesystem::path& directory,
                         const std::function<void()>& prepare = {}) {
  return Child(words, directory, prepare).Wait();
}

}  // namespace hindsight

#endif  // HINDSIGHT_TESTS_APP_COMMAND_LINE_H_
