#pragma once

#include <nlohmann/json.hpp>

#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace tissue_test {

/// What a program printed, on both streams, and its exit code.
struct Outcome {
  int code = -1;
  std::string output;
};

inline Outcome run_program(const std::string& program, const std::string& arguments) {
  Outcome outcome;
  FILE* pipe = popen((program + " " + arguments + " 2>&1").c_str(), "r");
  char buffer[256];
  while (fgets(buffer, sizeof(buffer), pipe) != nullptr) outcome.output += buffer;
  outcome.code = WEXITSTATUS(pclose(pipe));
  return outcome;
}

inline std::string temporary(const std::string& name) {
  return (std::filesystem::temp_directory_path() / name).string();
}

inline nlohmann::json read_json(const std::string& path) {
  return nlohmann::json::parse(std::ifstream(path));
}

}  // namespace tissue_test
