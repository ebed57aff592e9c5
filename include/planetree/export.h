#pragma once

/// @file
/// Marks what the library exports.

/// Marks a class or a function as part of the library's interface. If planetree is built as a
/// shared library, it exports the marked classes and functions and no other name. The attribute is
/// that of g++ and clang++.
#define PLANETREE_API [[gnu::visibility("default")]]
