"""Graph files: text -> tree with places -> models -> Plan -> check. Pure: reads files, imports and runs nothing."""
