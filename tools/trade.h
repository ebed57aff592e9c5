#pragma once

#include <functional>

#include "tools/cli/subcommand.h"
#include "tools/trade/trade_arguments.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Measures what the options of a query trade accuracy for. Returns the exit status.
int run_trade(const TradeArguments& arguments, Console& console);

/// Adds the subcommand `trade` to the command line. If given, parsing sets `action` to a call of
/// run_trade().
void add_trade(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
