//! What Parquet's structures hold, by the numbers of their fields, as far as the library reads them: a file's description and
//! a page's header, with all that they hold.
//!
//! Fields that the library passes over are left out, since it goes by what the file says of them: in a page's header the
//! statistics, in the rest what concerns encryption. The page index and Bloom filters are not read.

use super::thrift::Kind::{Boolean, Byte, Bytes, Double, List, Structure, Whole};
use super::thrift::Shape;

/// `FileMetaData`, which describes a file.
pub(super) static FILE: Shape = Shape(&[
    (1, Whole),                             // version
    (2, List(&Structure(&SCHEMA_ELEMENT))), // schema
    (3, Whole),                             // num_rows
    (4, List(&Structure(&ROW_GROUP))),      // row_groups
    (5, List(&Structure(&KEY_VALUE))),      // key_value_metadata
    (6, Bytes),                             // created_by
    (7, List(&Structure(&COLUMN_ORDER))),   // column_orders
]);

static SCHEMA_ELEMENT: Shape = Shape(&[
    (1, Whole),                     // type
    (2, Whole),                     // type_length
    (3, Whole),                     // repetition_type
    (4, Bytes),                     // name
    (5, Whole),                     // num_children
    (6, Whole),                     // converted_type
    (7, Whole),                     // scale
    (8, Whole),                     // precision
    (9, Whole),                     // field_id
    (10, Structure(&LOGICAL_TYPE)), // logicalType
]);

/// One field of these.
static LOGICAL_TYPE: Shape = Shape(&[
    (1, Structure(&EMPTY)),      // STRING
    (2, Structure(&EMPTY)),      // MAP
    (3, Structure(&EMPTY)),      // LIST
    (4, Structure(&EMPTY)),      // ENUM
    (5, Structure(&DECIMAL)),    // DECIMAL
    (6, Structure(&EMPTY)),      // DATE
    (7, Structure(&TIME)),       // TIME
    (8, Structure(&TIME)),       // TIMESTAMP
    (10, Structure(&INTEGER)),   // INTEGER
    (11, Structure(&EMPTY)),     // UNKNOWN
    (12, Structure(&EMPTY)),     // JSON
    (13, Structure(&EMPTY)),     // BSON
    (14, Structure(&EMPTY)),     // UUID
    (15, Structure(&EMPTY)),     // FLOAT16
    (16, Structure(&VARIANT)),   // VARIANT
    (17, Structure(&GEOMETRY)),  // GEOMETRY
    (18, Structure(&GEOGRAPHY)), // GEOGRAPHY
    (19, Structure(&EMPTY)),     // FILE
]);

static DECIMAL: Shape = Shape(&[
    (1, Whole), // scale
    (2, Whole), // precision
]);

static TIME: Shape = Shape(&[
    (1, Boolean),               // isAdjustedToUTC
    (2, Structure(&TIME_UNIT)), // unit
]);

/// One field of these.
static TIME_UNIT: Shape = Shape(&[
    (1, Structure(&EMPTY)), // MILLIS
    (2, Structure(&EMPTY)), // MICROS
    (3, Structure(&EMPTY)), // NANOS
]);

static INTEGER: Shape = Shape(&[
    (1, Byte),    // bitWidth
    (2, Boolean), // isSigned
]);

static VARIANT: Shape = Shape(&[
    (1, Byte), // specification_version
]);

static GEOMETRY: Shape = Shape(&[
    (1, Bytes), // crs
]);

static GEOGRAPHY: Shape = Shape(&[
    (1, Bytes), // crs
    (2, Whole), // algorithm
]);

static ROW_GROUP: Shape = Shape(&[
    (1, List(&Structure(&COLUMN_CHUNK))),   // columns
    (2, Whole),                             // total_byte_size
    (3, Whole),                             // num_rows
    (4, List(&Structure(&SORTING_COLUMN))), // sorting_columns
    (5, Whole),                             // file_offset
    (7, Whole),                             // ordinal
]);

static SORTING_COLUMN: Shape = Shape(&[
    (1, Whole),   // column_idx
    (2, Boolean), // descending
    (3, Boolean), // nulls_first
]);

static COLUMN_CHUNK: Shape = Shape(&[
    (1, Bytes),              // file_path
    (2, Whole),              // file_offset
    (3, Structure(&COLUMN)), // meta_data
    (4, Whole),              // offset_index_offset
    (5, Whole),              // offset_index_length
    (6, Whole),              // column_index_offset
    (7, Whole),              // column_index_length
]);

/// `ColumnMetaData`.
static COLUMN: Shape = Shape(&[
    (1, Whole),                             // type
    (2, List(&Whole)),                      // encodings
    (4, Whole),                             // codec
    (5, Whole),                             // num_values
    (6, Whole),                             // total_uncompressed_size
    (7, Whole),                             // total_compressed_size
    (9, Whole),                             // data_page_offset
    (10, Whole),                            // index_page_offset
    (11, Whole),                            // dictionary_page_offset
    (12, Structure(&STATISTICS)),           // statistics
    (13, List(&Structure(&PAGE_ENCODING))), // encoding_stats
    (14, Whole),                            // bloom_filter_offset
    (15, Whole),                            // bloom_filter_length
    (16, Structure(&SIZES)),                // size_statistics
    (17, Structure(&GEOSPATIAL)),           // geospatial_statistics
]);

static STATISTICS: Shape = Shape(&[
    (1, Bytes),   // max
    (2, Bytes),   // min
    (3, Whole),   // null_count
    (4, Whole),   // distinct_count
    (5, Bytes),   // max_value
    (6, Bytes),   // min_value
    (7, Boolean), // is_max_value_exact
    (8, Boolean), // is_min_value_exact
    (9, Whole),   // nan_count
]);

/// `PageEncodingStats`.
static PAGE_ENCODING: Shape = Shape(&[
    (1, Whole), // page_type
    (2, Whole), // encoding
    (3, Whole), // count
]);

/// `SizeStatistics`.
static SIZES: Shape = Shape(&[
    (1, Whole),        // unencoded_byte_array_data_bytes
    (2, List(&Whole)), // repetition_level_histogram
    (3, List(&Whole)), // definition_level_histogram
]);

/// `GeospatialStatistics`.
static GEOSPATIAL: Shape = Shape(&[
    (1, Structure(&BOUNDING_BOX)), // bbox
    (2, List(&Whole)),             // geospatial_types
]);

/// Bounds of x, y, z and m, the lower one first.
static BOUNDING_BOX: Shape =
    Shape(&[(1, Double), (2, Double), (3, Double), (4, Double), (5, Double), (6, Double), (7, Double), (8, Double)]);

static KEY_VALUE: Shape = Shape(&[
    (1, Bytes), // key
    (2, Bytes), // value
]);

/// One field of these.
static COLUMN_ORDER: Shape = Shape(&[
    (1, Structure(&EMPTY)), // TYPE_ORDER
    (2, Structure(&EMPTY)), // IEEE_754_TOTAL_ORDER
    (3, Structure(&EMPTY)), // INT96_TIMESTAMP_ORDER
]);

/// Where being there says everything.
static EMPTY: Shape = Shape(&[]);

/// `PageHeader`.
pub(super) static PAGE: Shape = Shape(&[
    (1, Whole),                       // type
    (2, Whole),                       // uncompressed_page_size
    (3, Whole),                       // compressed_page_size
    (4, Whole),                       // crc
    (5, Structure(&DATA_PAGE)),       // data_page_header
    (6, Structure(&EMPTY)),           // index_page_header
    (7, Structure(&DICTIONARY_PAGE)), // dictionary_page_header
    (8, Structure(&DATA_PAGE_V2)),    // data_page_header_v2
]);

static DATA_PAGE: Shape = Shape(&[
    (1, Whole), // num_values
    (2, Whole), // encoding
    (3, Whole), // definition_level_encoding
    (4, Whole), // repetition_level_encoding
]);

static DICTIONARY_PAGE: Shape = Shape(&[
    (1, Whole),   // num_values
    (2, Whole),   // encoding
    (3, Boolean), // is_sorted
]);

static DATA_PAGE_V2: Shape = Shape(&[
    (1, Whole),   // num_values
    (2, Whole),   // num_nulls
    (3, Whole),   // num_rows
    (4, Whole),   // encoding
    (5, Whole),   // definition_levels_byte_length
    (6, Whole),   // repetition_levels_byte_length
    (7, Boolean), // is_compressed
]);
