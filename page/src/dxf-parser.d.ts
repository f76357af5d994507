/** What is used of dxf-parser, whose own types ask for those of Node. */
declare module "dxf-parser/dist/dxf-parser.js" {
  export default class DxfParser {
    parseSync(text: string): { header?: Record<string, unknown>; entities?: unknown[]; blocks?: unknown } | null;
  }
}
