#pragma once

#include <boost/program_options.hpp>

#include <functional>
#include <string>

namespace tissue_tools {

/// A command-line program: reads the options, shows them for --help, and calls `run`. Returns the
/// exit code: 0, or 2 with one sentence on stderr that names what was wrong.
int run_program(const std::string& name, const boost::program_options::options_description& options,
                const std::string& positional, int argc, char** argv,
                const std::function<void(const boost::program_options::variables_map&)>& run);

/// What was given for an option. Throws tissue::InputError E_PARAM if nothing was.
std::string required(const boost::program_options::variables_map& given, const char* option);

/// Writes a text file. Throws tissue::InputError E_IO that names the option.
void write_text(const std::string& option, const std::string& path, const std::string& text);

/// One line of progress that is written again and again, on a terminal only. `done` is from 0 to 1.
void show_progress(double done, const std::string& what);

}  // namespace tissue_tools
