#pragma once

/// @file
/// The structs and constants of the interface in C11. Include planetree/c.h, which has the calls.

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PLANETREE_NO_TRIANGLE UINT64_MAX  ///< index of answers without a triangle
#define PLANETREE_NOWHERE UINT64_MAX      ///< planetree_error::page and offset: none
#define PLANETREE_NO_LIMIT UINT32_MAX     ///< planetree_query_options::max_work: no limit

/// An open file. Any number of threads may share one. It must outlive its probes.
typedef struct planetree_model planetree_model;
/// Runs queries. For one thread at a time.
typedef struct planetree_probe planetree_probe;

/// Kinds of failures, as planetree::ErrorCode.
enum planetree_code {
  PLANETREE_OK = 0,
  PLANETREE_BAD_ARGUMENT = 1,
  PLANETREE_NOT_FOUND = 2,
  PLANETREE_ALREADY_EXISTS = 3,
  PLANETREE_PERMISSION = 4,
  PLANETREE_NO_SPACE = 5,
  PLANETREE_NO_MEMORY = 6,
  PLANETREE_READ_FAILED = 7,
  PLANETREE_WRITE_FAILED = 8,
  PLANETREE_BAD_INPUT = 9,
  PLANETREE_NOT_PLANETREE = 10,
  PLANETREE_UNSUPPORTED = 11,
  PLANETREE_TRUNCATED = 12,
  PLANETREE_DAMAGED = 13,
  PLANETREE_CANCELLED = 14
};

/// Where a point is with respect to the solid, as planetree::Side.
enum planetree_side {
  PLANETREE_INSIDE = 0,
  PLANETREE_OUTSIDE = 1,
  PLANETREE_ON_SURFACE = 2,
  PLANETREE_SIDE_UNKNOWN = 3
};
/// Kind of part of a triangle that a point is on, as planetree::Feature.
enum planetree_feature { PLANETREE_FACE = 0, PLANETREE_EDGE = 1, PLANETREE_VERTEX = 2 };
/// How certain an answer is, as planetree::Status.
enum planetree_status {
  PLANETREE_EXACT = 0,
  PLANETREE_WITHIN_ERROR = 1,
  PLANETREE_DEGRADED = 2,
  PLANETREE_BEYOND_MAX_DISTANCE = 3,
  PLANETREE_BAD_QUERY = 4
};
/// Parts of an answer, as planetree/types.h says.
enum planetree_part { PLANETREE_DISTANCE = 1, PLANETREE_SIDE = 2, PLANETREE_NORMAL = 4 };
/// Parts of a file, as planetree/layers.h says.
enum planetree_layer {
  PLANETREE_DISTANCE_LAYER = 1,
  PLANETREE_SIDE_LAYER = 2,
  PLANETREE_FIELD_LAYER = 4,
  PLANETREE_ATTRIBUTE_LAYER = 8
};
/// What a file keeps of each triangle beside its shape, as planetree/attributes.h says.
enum planetree_attribute {
  PLANETREE_KEEP_TRIANGLES = 1,
  PLANETREE_KEEP_COLOR = 2,
  PLANETREE_KEEP_UV = 4,
  PLANETREE_KEEP_VALUE = 8
};
/// Types of values of triangles, as planetree::ValueKind.
enum planetree_value_kind {
  PLANETREE_VALUE_UNSIGNED = 0,
  PLANETREE_VALUE_SIGNED = 1,
  PLANETREE_VALUE_REAL = 2
};
/// How sides are decided, as planetree::SideRule.
enum planetree_side_rule {
  PLANETREE_RULE_OF_FILE = 0,
  PLANETREE_RULE_SOLID = 1,
  PLANETREE_RULE_SURFACE = 2
};
/// Where normals point, as planetree::NormalRule.
enum planetree_normal_rule { PLANETREE_OUTWARD = 0, PLANETREE_TOWARD_QUERY = 1 };

/// A failure: its kind, its place in the file, and its cause and remedy in one line.
typedef struct planetree_error {
  uint32_t code;    ///< a planetree_code
  uint64_t page;    ///< page of the file, or PLANETREE_NOWHERE
  uint64_t offset;  ///< byte of the file, or PLANETREE_NOWHERE
  char text[192];   ///< ended by 0
} planetree_error;

/// Options of planetree_open(), as planetree::OpenOptions.
typedef struct planetree_open_options {
  size_t struct_bytes;           ///< size of this struct
  uint64_t memory_budget_bytes;  ///< maximum memory of the model
  uint32_t fetch_threads;        ///< threads that read pages
  uint32_t batch_threads;        ///< threads that answer batches
  uint32_t max_probes;           ///< maximum number of probes
  uint32_t layers;               ///< a sum of planetree_layer
  uint32_t wait_limit_ms;        ///< longest wait of a query for one page
  bool requires_locking;         ///< whether memory that cannot be locked is a failure
  bool read_ahead;               ///< read all pages of a model that fits into memory
  bool uses_io_uring;            ///< wait for pages by io_uring
  bool allows_missing_members;   ///< open a set of which members are missing
  const char* http_cache;        ///< directory that keeps what is read of a URL; null: nowhere
  uint64_t http_cache_bytes;     ///< maximum length of the file there
} planetree_open_options;

/// Contents of a file, as planetree::ModelInfo.
typedef struct planetree_info {
  uint64_t triangles;         ///< number of triangles in the file
  uint64_t skipped;           ///< number of triangle indices of skipped records
  uint64_t vertices;          ///< vertex records of the input
  uint64_t unbalanced_edges;  ///< 0: the surface is watertight
  double box_lower[3];        ///< lower corner of the input's box
  double box_upper[3];        ///< upper corner of the input's box
  double core_lower[3];       ///< lower corner of the box of all triangles but strays
  double core_upper[3];       ///< upper corner of that box
  uint32_t side_rule;         ///< a planetree_side_rule
  uint32_t layers;            ///< a sum of planetree_layer
  uint32_t pages;             ///< number of pages
  uint32_t page_bytes;        ///< maximum bytes of a page in memory
  uint64_t file_bytes;        ///< length of the file
  uint32_t attributes;        ///< a sum of planetree_attribute
  uint32_t value_kind;        ///< a planetree_value_kind
} planetree_info;

/// State and counters of an open file, as planetree::Stats.
typedef struct planetree_stats {
  uint64_t page_hits;          ///< page lookups that found the page in memory
  uint64_t page_misses;        ///< page lookups that did not
  uint64_t pages_read;         ///< pages read from the file
  uint64_t pages_evicted;      ///< pages evicted to make room for others
  uint64_t quarantined_pages;  ///< pages found unreadable or damaged
  uint64_t degraded_answers;   ///< answers of PLANETREE_DEGRADED
  uint64_t frames;             ///< maximum number of pages in memory
  uint64_t budget_bytes;       ///< planetree_open_options::memory_budget_bytes
  uint64_t locked_bytes;       ///< locked memory
} planetree_stats;

/// Options of a query, as planetree::QueryOptions. Where a call takes a pointer to them, null means
/// the defaults.
typedef struct planetree_query_options {
  size_t struct_bytes;   ///< size of this struct
  uint32_t parts;        ///< a sum of planetree_part
  uint32_t side_rule;    ///< a planetree_side_rule
  uint32_t normal_rule;  ///< a planetree_normal_rule
  uint32_t max_work;     ///< units of work, or PLANETREE_NO_LIMIT
  double max_error;      ///< allowed error of the distance; 0: exact
  double max_distance;   ///< distance to search within
  bool never_waits;      ///< true: a real-time query, which does not wait for pages
} planetree_query_options;

/// The nearest surface point of a query point, as planetree::ClosestPoint.
typedef struct planetree_closest_point {
  double distance;        ///< to the nearest surface point, >= 0
  double lower;           ///< certified: the true distance is in [lower, upper]
  double upper;           ///< certified too; infinite if the distance is
  uint8_t side;           ///< a planetree_side
  double point[3];        ///< the nearest surface point
  double normal[3];       ///< unit normal there, by the normal rule
  uint64_t triangle;      ///< index of the nearest triangle, or PLANETREE_NO_TRIANGLE
  double barycentric[3];  ///< weights of the corners at the point
  uint8_t feature;        ///< a planetree_feature
  uint8_t status;         ///< a planetree_status
} planetree_closest_point;

/// The points origin + t * direction with t_min <= t <= t_max.
typedef struct planetree_ray {
  double origin[3];     ///< the point of t = 0
  double direction[3];  ///< of any length but 0
  double t_min;         ///< the least t
  double t_max;         ///< the greatest t; may be infinite
} planetree_ray;

/// A point where a ray passes through a triangle, as planetree::RayHit.
typedef struct planetree_hit {
  double t;               ///< infinite if there is no hit
  double t_lower;         ///< certified: the ray passes through no triangle before it
  double t_upper;         ///< of an exact hit: the true t is at most this
  double point[3];        ///< the point, on the triangle
  double normal[3];       ///< unit normal of the triangle, as the mesh orients it
  uint64_t triangle;      ///< index of the triangle, or PLANETREE_NO_TRIANGLE
  double barycentric[3];  ///< weights of the corners at the point
  bool entering;          ///< whether the ray goes against the triangle's normal
  uint8_t status;         ///< a planetree_status
} planetree_hit;

/// The straight motion of a ball while t goes from 0 to 1.
typedef struct planetree_sweep {
  double from[3];  ///< centre at t = 0
  double to[3];    ///< centre at t = 1
  double radius;   ///< model units, >= 0
} planetree_sweep;

/// The first contact of a moving ball, as planetree::FirstContact.
typedef struct planetree_first_contact {
  double t;                    ///< of the first contact
  double t_lower;              ///< certified: before it the ball is free
  double t_upper;              ///< certified: the ball touches at or before it
  planetree_closest_point at;  ///< the surface point that the ball touches
  bool free;                   ///< certainly no contact in all of the motion
  uint8_t status;              ///< a planetree_status
} planetree_first_contact;

/// A triangle of the mesh, as planetree::MeshTriangle. What the file does not keep is 0, and alpha
/// is 255.
typedef struct planetree_triangle {
  double corners[3][3];  ///< positions of the corners
  uint8_t colors[3][4];  ///< red, green, blue and alpha of the corners
  float uvs[3][2];       ///< texture coordinates of the corners
  uint64_t value;        ///< the bits, see planetree_info
} planetree_triangle;

/// What a query for several answers found.
typedef struct planetree_found {
  size_t count;   ///< answers written
  bool complete;  ///< whether no other one belongs to the set
} planetree_found;

/// Options of builds, as planetree::BuildOptions.
typedef struct planetree_build_options {
  size_t struct_bytes;         ///< size of this struct
  uint64_t memory_bytes;       ///< maximum memory; 0: a quarter of the machine's
  uint32_t threads;            ///< 0: one for each processor
  uint32_t page_bytes;         ///< maximum bytes of a page in memory; a power of two
  uint32_t layers;             ///< a sum of planetree_layer
  uint32_t side_rule;          ///< PLANETREE_RULE_OF_FILE: as the mesh suggests
  const char* temp_directory;  ///< null: the directory of the output
  uint32_t keep;               ///< attributes that the file keeps: a sum of planetree_attribute
  const char* value_property;  ///< property of a PLY's faces for PLANETREE_KEEP_VALUE
  uint64_t member_bytes;       ///< 0: one file; else a set of members of up to so many bytes
  bool resume;                 ///< resume from the checkpoint of an interrupted build
  bool strict;                 ///< refuse bad records instead of skipping them
  bool replace;                ///< replace the output if it exists
  /// Called with `context` and the progress of a phase; returns false to cancel the build. Calls
  /// come from any thread, but never two at the same time. May be null.
  bool (*on_progress)(void* context, const char* phase, uint64_t done, uint64_t total);
  void* context;  ///< for on_progress
} planetree_build_options;

/// What was built, as planetree::BuildReport.
typedef struct planetree_build_report {
  uint64_t triangles;         ///< number of triangles in the file
  uint64_t skipped;           ///< number of triangle indices of skipped records
  uint64_t unbalanced_edges;  ///< 0: the surface is watertight
  uint64_t file_bytes;        ///< length of the file
  uint32_t side_rule;         ///< a planetree_side_rule
  uint32_t layers;            ///< a sum of planetree_layer
} planetree_build_report;
