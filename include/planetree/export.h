#pragma once

/// @file
/// Marks what the library exports.

/// Marks a class or a function as part of the library's interface. A shared library exports what
/// has this mark and nothing else.
#define PLANETREE_API [[gnu::visibility("default")]]
