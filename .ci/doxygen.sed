# Makes the headers' plain comments doxygen's: before a declaration, behind one, of a file.
s|^( {8,})//( .*)?$|\1///<\2|
s|^( *)//( .*)?$|\1///\2|
s|^( *[^ /].*[;,{)]) +// (.*)$|\1  ///< \2|
# What stands in them is text.
/\/\/\//{
  h
  s|^(.*///<?).*$|\1|
  x
  s|^.*///<?||
  s/[\\@&<>#%"$]/\\&/g
  H
  x
  s|\n||
}
1s|^/// |/// \\file\n/// |
