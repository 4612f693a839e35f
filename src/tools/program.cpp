#include "program.h"

#include "tissue/base/error.h"

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iostream>

namespace tissue_tools {

namespace po = boost::program_options;
using tissue::ErrorCode;
using tissue::InputError;

int run_program(const std::string& name, const po::options_description& options,
                const std::string& positional, int argc, char** argv,
                const std::function<void(const po::variables_map&)>& run) {
  try {
    po::positional_options_description positions;
    positions.add(positional.c_str(), 1);
    po::variables_map given;
    // Negative numbers are values, not options.
    const auto style = po::command_line_style::unix_style ^ po::command_line_style::allow_guessing;
    po::store(po::command_line_parser(argc, argv)
                  .options(options)
                  .positional(positions)
                  .style(style)
                  .run(),
              given);
    if (given.count("help") != 0) {
      std::cout << options;
      return 0;
    }
    run(given);
    return 0;
  } catch (const std::bad_alloc&) {
    std::cerr << name << ": out of memory\n";
  } catch (const InputError& error) {
    std::cerr << name << ": " << tissue::name(error.code()) << ": " << error.what() << '\n';
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << '\n';
  }
  return 2;
}

std::string required(const po::variables_map& given, const char* option) {
  if (given.count(option) != 0) return given[option].as<std::string>();
  throw InputError(ErrorCode::kParam, std::string(option) + ": is missing; --help says how");
}

void write_text(const std::string& option, const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text << '\n';
  file.close();
  if (!file) throw InputError(ErrorCode::kIo, option + ": '" + path + "' cannot be written");
}

void show_progress(double done, const std::string& what) {
  if (isatty(STDERR_FILENO) == 0) return;
  constexpr int kWidth = 30;
  const int marks = static_cast<int>(done * kWidth + 0.5);
  std::fprintf(stderr, "\r[%s%s] %3.0f %% %-30s", std::string(marks, '#').c_str(),
               std::string(kWidth - marks, ' ').c_str(), 100.0 * done, what.c_str());
  if (done >= 1.0) std::fprintf(stderr, "\r%70s\r", "");
}

}  // namespace tissue_tools
