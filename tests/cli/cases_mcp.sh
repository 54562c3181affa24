# cag mcp: a client tries each tool, and hostile input (mcp_client.py).

it 'a client of the protocol is served' python3
try_command timeout 300 python3 "$here/mcp_client.py" "$CAG"
status 0
prints ' 0 failed'

it 'a folder that is missing'
try mcp missing
status 3
says 'missing'

it 'scripts are found in the folder that is named'
mkdir models
echo 'print "found"' > models/a.cag
printf '%s\n' '{"jsonrpc":"2.0","id":1,"method":"tools/call","params":{"name":"run","arguments":{"file":"a.cag"}}}' > request
with_input request mcp models
status 0
prints '"output":"found\n"'
printf '%s\n' '{"jsonrpc":"2.0","id":1,"method":"tools/call","params":{"name":"run","arguments":{"file":"../request"}}}' > request
with_input request mcp models
prints '"code":-32602'
