"""The other side of tests/schema.rs: files held against a schema by Python's `jsonschema` 4.26.

    schema_peer.py SCHEMA.json FILE.toml...    one line per file: `right`, or `wrong KEY: what is wrong`
"""

import json
import sys
import tomllib

from jsonschema import Draft7Validator

with open(sys.argv[1]) as file:
    schema = json.load(file)
Draft7Validator.check_schema(schema)
validator = Draft7Validator(schema)
for path in sys.argv[2:]:
    with open(path, "rb") as file:
        errors = sorted(validator.iter_errors(tomllib.load(file)), key=lambda e: list(map(str, e.absolute_path)))
    if errors:
        place = ".".join(map(str, errors[0].absolute_path))
        print(f"wrong {place}: {errors[0].message[:200]}")
    else:
        print("right")
