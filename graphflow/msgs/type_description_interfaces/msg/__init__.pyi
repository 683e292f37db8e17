# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

from graphflow.msgs import base

class Field(base.Message):
    name: str
    type: FieldType
    default_value: str
    def __init__(
        self,
        *,
        name: str = ...,
        type: FieldType | Mapping[str, object] = ...,
        default_value: str = ...,
    ) -> None: ...

class FieldType(base.Message):
    FIELD_TYPE_NOT_SET: ClassVar[Literal[0]]
    FIELD_TYPE_NESTED_TYPE: ClassVar[Literal[1]]
    FIELD_TYPE_INT8: ClassVar[Literal[2]]
    FIELD_TYPE_UINT8: ClassVar[Literal[3]]
    FIELD_TYPE_INT16: ClassVar[Literal[4]]
    FIELD_TYPE_UINT16: ClassVar[Literal[5]]
    FIELD_TYPE_INT32: ClassVar[Literal[6]]
    FIELD_TYPE_UINT32: ClassVar[Literal[7]]
    FIELD_TYPE_INT64: ClassVar[Literal[8]]
    FIELD_TYPE_UINT64: ClassVar[Literal[9]]
    FIELD_TYPE_FLOAT: ClassVar[Literal[10]]
    FIELD_TYPE_DOUBLE: ClassVar[Literal[11]]
    FIELD_TYPE_LONG_DOUBLE: ClassVar[Literal[12]]
    FIELD_TYPE_CHAR: ClassVar[Literal[13]]
    FIELD_TYPE_WCHAR: ClassVar[Literal[14]]
    FIELD_TYPE_BOOLEAN: ClassVar[Literal[15]]
    FIELD_TYPE_BYTE: ClassVar[Literal[16]]
    FIELD_TYPE_STRING: ClassVar[Literal[17]]
    FIELD_TYPE_WSTRING: ClassVar[Literal[18]]
    FIELD_TYPE_FIXED_STRING: ClassVar[Literal[19]]
    FIELD_TYPE_FIXED_WSTRING: ClassVar[Literal[20]]
    FIELD_TYPE_BOUNDED_STRING: ClassVar[Literal[21]]
    FIELD_TYPE_BOUNDED_WSTRING: ClassVar[Literal[22]]
    FIELD_TYPE_NESTED_TYPE_ARRAY: ClassVar[Literal[49]]
    FIELD_TYPE_INT8_ARRAY: ClassVar[Literal[50]]
    FIELD_TYPE_UINT8_ARRAY: ClassVar[Literal[51]]
    FIELD_TYPE_INT16_ARRAY: ClassVar[Literal[52]]
    FIELD_TYPE_UINT16_ARRAY: ClassVar[Literal[53]]
    FIELD_TYPE_INT32_ARRAY: ClassVar[Literal[54]]
    FIELD_TYPE_UINT32_ARRAY: ClassVar[Literal[55]]
    FIELD_TYPE_INT64_ARRAY: ClassVar[Literal[56]]
    FIELD_TYPE_UINT64_ARRAY: ClassVar[Literal[57]]
    FIELD_TYPE_FLOAT_ARRAY: ClassVar[Literal[58]]
    FIELD_TYPE_DOUBLE_ARRAY: ClassVar[Literal[59]]
    FIELD_TYPE_LONG_DOUBLE_ARRAY: ClassVar[Literal[60]]
    FIELD_TYPE_CHAR_ARRAY: ClassVar[Literal[61]]
    FIELD_TYPE_WCHAR_ARRAY: ClassVar[Literal[62]]
    FIELD_TYPE_BOOLEAN_ARRAY: ClassVar[Literal[63]]
    FIELD_TYPE_BYTE_ARRAY: ClassVar[Literal[64]]
    FIELD_TYPE_STRING_ARRAY: ClassVar[Literal[65]]
    FIELD_TYPE_WSTRING_ARRAY: ClassVar[Literal[66]]
    FIELD_TYPE_FIXED_STRING_ARRAY: ClassVar[Literal[67]]
    FIELD_TYPE_FIXED_WSTRING_ARRAY: ClassVar[Literal[68]]
    FIELD_TYPE_BOUNDED_STRING_ARRAY: ClassVar[Literal[69]]
    FIELD_TYPE_BOUNDED_WSTRING_ARRAY: ClassVar[Literal[70]]
    FIELD_TYPE_NESTED_TYPE_BOUNDED_SEQUENCE: ClassVar[Literal[97]]
    FIELD_TYPE_INT8_BOUNDED_SEQUENCE: ClassVar[Literal[98]]
    FIELD_TYPE_UINT8_BOUNDED_SEQUENCE: ClassVar[Literal[99]]
    FIELD_TYPE_INT16_BOUNDED_SEQUENCE: ClassVar[Literal[100]]
    FIELD_TYPE_UINT16_BOUNDED_SEQUENCE: ClassVar[Literal[101]]
    FIELD_TYPE_INT32_BOUNDED_SEQUENCE: ClassVar[Literal[102]]
    FIELD_TYPE_UINT32_BOUNDED_SEQUENCE: ClassVar[Literal[103]]
    FIELD_TYPE_INT64_BOUNDED_SEQUENCE: ClassVar[Literal[104]]
    FIELD_TYPE_UINT64_BOUNDED_SEQUENCE: ClassVar[Literal[105]]
    FIELD_TYPE_FLOAT_BOUNDED_SEQUENCE: ClassVar[Literal[106]]
    FIELD_TYPE_DOUBLE_BOUNDED_SEQUENCE: ClassVar[Literal[107]]
    FIELD_TYPE_LONG_DOUBLE_BOUNDED_SEQUENCE: ClassVar[Literal[108]]
    FIELD_TYPE_CHAR_BOUNDED_SEQUENCE: ClassVar[Literal[109]]
    FIELD_TYPE_WCHAR_BOUNDED_SEQUENCE: ClassVar[Literal[110]]
    FIELD_TYPE_BOOLEAN_BOUNDED_SEQUENCE: ClassVar[Literal[111]]
    FIELD_TYPE_BYTE_BOUNDED_SEQUENCE: ClassVar[Literal[112]]
    FIELD_TYPE_STRING_BOUNDED_SEQUENCE: ClassVar[Literal[113]]
    FIELD_TYPE_WSTRING_BOUNDED_SEQUENCE: ClassVar[Literal[114]]
    FIELD_TYPE_FIXED_STRING_BOUNDED_SEQUENCE: ClassVar[Literal[115]]
    FIELD_TYPE_FIXED_WSTRING_BOUNDED_SEQUENCE: ClassVar[Literal[116]]
    FIELD_TYPE_BOUNDED_STRING_BOUNDED_SEQUENCE: ClassVar[Literal[117]]
    FIELD_TYPE_BOUNDED_WSTRING_BOUNDED_SEQUENCE: ClassVar[Literal[118]]
    FIELD_TYPE_NESTED_TYPE_UNBOUNDED_SEQUENCE: ClassVar[Literal[145]]
    FIELD_TYPE_INT8_UNBOUNDED_SEQUENCE: ClassVar[Literal[146]]
    FIELD_TYPE_UINT8_UNBOUNDED_SEQUENCE: ClassVar[Literal[147]]
    FIELD_TYPE_INT16_UNBOUNDED_SEQUENCE: ClassVar[Literal[148]]
    FIELD_TYPE_UINT16_UNBOUNDED_SEQUENCE: ClassVar[Literal[149]]
    FIELD_TYPE_INT32_UNBOUNDED_SEQUENCE: ClassVar[Literal[150]]
    FIELD_TYPE_UINT32_UNBOUNDED_SEQUENCE: ClassVar[Literal[151]]
    FIELD_TYPE_INT64_UNBOUNDED_SEQUENCE: ClassVar[Literal[152]]
    FIELD_TYPE_UINT64_UNBOUNDED_SEQUENCE: ClassVar[Literal[153]]
    FIELD_TYPE_FLOAT_UNBOUNDED_SEQUENCE: ClassVar[Literal[154]]
    FIELD_TYPE_DOUBLE_UNBOUNDED_SEQUENCE: ClassVar[Literal[155]]
    FIELD_TYPE_LONG_DOUBLE_UNBOUNDED_SEQUENCE: ClassVar[Literal[156]]
    FIELD_TYPE_CHAR_UNBOUNDED_SEQUENCE: ClassVar[Literal[157]]
    FIELD_TYPE_WCHAR_UNBOUNDED_SEQUENCE: ClassVar[Literal[158]]
    FIELD_TYPE_BOOLEAN_UNBOUNDED_SEQUENCE: ClassVar[Literal[159]]
    FIELD_TYPE_BYTE_UNBOUNDED_SEQUENCE: ClassVar[Literal[160]]
    FIELD_TYPE_STRING_UNBOUNDED_SEQUENCE: ClassVar[Literal[161]]
    FIELD_TYPE_WSTRING_UNBOUNDED_SEQUENCE: ClassVar[Literal[162]]
    FIELD_TYPE_FIXED_STRING_UNBOUNDED_SEQUENCE: ClassVar[Literal[163]]
    FIELD_TYPE_FIXED_WSTRING_UNBOUNDED_SEQUENCE: ClassVar[Literal[164]]
    FIELD_TYPE_BOUNDED_STRING_UNBOUNDED_SEQUENCE: ClassVar[Literal[165]]
    FIELD_TYPE_BOUNDED_WSTRING_UNBOUNDED_SEQUENCE: ClassVar[Literal[166]]
    type_id: int
    capacity: int
    string_capacity: int
    nested_type_name: str
    def __init__(
        self,
        *,
        type_id: int = ...,
        capacity: int = ...,
        string_capacity: int = ...,
        nested_type_name: str = ...,
    ) -> None: ...

class IndividualTypeDescription(base.Message):
    type_name: str
    fields: list[Field]
    def __init__(self, *, type_name: str = ..., fields: Sequence[Field | Mapping[str, object]] = ...) -> None: ...

class KeyValue(base.Message):
    key: str
    value: str
    def __init__(self, *, key: str = ..., value: str = ...) -> None: ...

class TypeDescription(base.Message):
    type_description: IndividualTypeDescription
    referenced_type_descriptions: list[IndividualTypeDescription]
    def __init__(
        self,
        *,
        type_description: IndividualTypeDescription | Mapping[str, object] = ...,
        referenced_type_descriptions: Sequence[IndividualTypeDescription | Mapping[str, object]] = ...,
    ) -> None: ...

class TypeSource(base.Message):
    type_name: str
    encoding: str
    raw_file_contents: str
    def __init__(self, *, type_name: str = ..., encoding: str = ..., raw_file_contents: str = ...) -> None: ...
