#pragma once

namespace CLI {
class App;
}

namespace volgi::app {

/// Each command adds its subcommand to `app`; running it stores the exit code (core/error.h) in `exit_code`. Errors are
/// thrown as volgi::Error and become one line on stderr in main.
void add_render_command(CLI::App& app, int& exit_code);
void add_reference_command(CLI::App& app, int& exit_code);
void add_compare_command(CLI::App& app, int& exit_code);
void add_export_command(CLI::App& app, int& exit_code);
void add_merge_command(CLI::App& app, int& exit_code);
void add_inspect_command(CLI::App& app, int& exit_code);
void add_crosscheck_command(CLI::App& app, int& exit_code);
void add_bench_command(CLI::App& app, int& exit_code);
void add_report_command(CLI::App& app, int& exit_code);
void add_calibrate_command(CLI::App& app, int& exit_code);

}  // namespace volgi::app
